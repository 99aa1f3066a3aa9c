"""Geometry of a face-gear drive (chapter 3): a `Drive` with its limits, and where its teeth touch.

Flanks and contact lines (`flanks`, `contact_lines`, `recut`), path of the contact on its clock (`kinematics`), contact
at a point with a larger shaper, aligned or not (`point_contact`, its `action_lines`, `misalignment`, `hertz` and
`point_path`), phases between several pinions (`phases`), outlines and solids (`solids`).
Public: `Drive`, `ContactPath`, `SkewLine`, `UnloadedContact`, `Misalignment`, `mesh_period`, `phase_split`.
"""
