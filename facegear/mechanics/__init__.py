"""Mechanical models that become a `PeriodicSystem` at each speed.

Where teeth press and when: `contact`, on `paths`. How they share the load: by a rule (`sharing`), or under load with
their own `compliance` (`loaded_contact` over its `mesh_cycle`, on `slices` of the face and their `slice_gap`;
`contact_pattern` on the flank), that of plates in `plate_compliance`, `line_influence`, `elastic_teeth` and
`cantilever_plate`. The stiffness of teeth is in `tooth_stiffness` (chapter 7).

The disk: `plate` with its `radial_modes`, `mode_shapes` and the equations of `disk`; under pinions (`pinions_on_disk`)
on bearings alone `transverse`, at very many angles `rotation` (4, 5), on the springs of their teeth `mesh_oscillator`
and `two_gears` (8).
A force at its rim or on its teeth: stress in the plane (`inplane`) and the stiffness of it (`edge_stiffness`; 6),
`spreads` over teeth, their `pressed_points` and `pressed_stiffness` (8).

The gearbox in torsion (`torsional`; 7), with play between its teeth (`backlash`), with a damaged one (`tooth_damage`),
with shafts that have mass (`heavy_shafts`, as `rods` or `exact_rods`; 8). The classical equations (`classical`,
`classical_pairs`; 2). Material and bearings are `properties`, the dissertation's own drives `cases` and `gearboxes`.
Public: `STEEL`, `MeshLoad`, `Body`, `Contact`, `DrivingForce`, `EdgeLoadStress`, `Transverse`, `Gearbox`, `Torsional`,
`MeshOscillator`, `TwoGears`.
"""
