"""Geometry of a face-gear drive (chapter 3): a `Drive` with its limits, and where its teeth touch.

The drive is in `drive`; it stands on `proportions`, what follows from tooth numbers, module and angles alone, and on
`tooth_limits`, where undercutting ends and the tooth is pointed. Flanks and contact lines (`flanks`,
`generated_flank`, `contact_lines`, and what the shaper cuts off again in `recut` and `cut_lines`),
pairs on the clock of mesh periods (`timed_pairs`) and their paths (`kinematics`, `skew_line`), contact at a point with
a larger shaper, aligned or not (`point_contact`, the `action_path` below it and its `action_lines` with their
`vectors`, `misalignment`, `hertz` and `point_path`), phases between several pinions (`phases`), outlines and solids
(`solids`).
Public: `Drive`, `ContactPath`, `SkewLine`, `UnloadedContact`, `Misalignment`, `mesh_period`, `phase_split`.
"""
