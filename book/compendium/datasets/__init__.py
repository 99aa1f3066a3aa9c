"""Arrays of the figures of the chapters, labelled, with units and the tolerances at which they are checked.

One module a subject: `stability` and `accuracy` of chapter 2, `meshing` of 3, `disk`, `transverse` and `design` of 4,
`pinions` of 5, `inplane` and `power` of 6, `torsional`, `torsional_design` and `modulation` of 7; of chapter 8 `levers`
(8.1), `contact_load`, `flexible_teeth`, `spread_force`, `backlash`, `damage` and `heavy_shafts`.
"""
