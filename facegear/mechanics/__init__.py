"""Mechanical models that become a `PeriodicSystem` at each speed.

Where teeth press and when (`contact`, on `paths`), how they share the load by a rule (`sharing`) or under load with
their own compliance (`loaded_contact`, `slices`, `compliance`, that of plates in `plate_compliance`, `line_influence`,
`elastic_teeth`, `cantilever_plate`; `contact_pattern` on the flank), the spinning disk under its pinions (`plate`, its
`radial_modes` and `mode_shapes`, `disk`, `transverse`, `rotation`; chapters 4 and 5), under a force at its rim or on
its teeth (`inplane`, `edge_stiffness`, `pressed_points`, `spreads`, `pressed_stiffness`; 6, 8) and under pinions on the
springs of their teeth (`mesh_oscillator`, `two_gears`; 8), the stiffness of teeth (`tooth_stiffness`; 7) and the
gearbox in torsion (`torsional`; 7), with play between its teeth (`backlash`; 8), with a damaged one (`tooth_damage`; 8)
and with shafts that have mass (`rods`, `exact_rods`, `heavy_shafts`; 8), the classical equations (`classical`,
`classical_pairs`; 2), material and bearings (`properties`), the dissertation's own drives (`cases`, `gearboxes`).
Public: `STEEL`, `MeshLoad`, `Body`, `Contact`, `DrivingForce`, `EdgeLoadStress`, `Transverse`, `Gearbox`, `Torsional`,
`MeshOscillator`, `TwoGears`.
"""
