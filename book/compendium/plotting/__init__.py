"""Figures of the chapters. Nothing here computes: every function draws arrays that it is given.

One module a subject: `stability` of chapter 2; `meshing`, `tooth_limits`, `contact_load` and the explanations of
`schematics` of 3; `transverse` and `design` of 4; `pinions` and `cancellation` of 5; `inplane` of 6; `torsional` and
`torsional_design` of 7; of chapter 8 `levers`, `flexible_teeth`, `spread_force`, `backlash`, `damage` and
`heavy_shafts`. The mechanical models of all chapters are drawn in `models` and `model_details`, of springs and
masses in `parts`; `vignette` is the title page's picture.
"""
