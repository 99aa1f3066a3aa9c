"""Arrays of the figures of the chapters, labelled, with units and the tolerances at which they are checked.

One module a subject: `stability` and `accuracy` of chapter 2; `meshing`, `tooth_limits`, `contact_load` and
`contact_vibration` of 3; `disk`, `transverse`, `design` and `design_variants` of 4; `pinions` and `cancellation` of 5;
`inplane` and `power` of 6; `torsional`, `torsional_design` and `modulation` of 7; of chapter 8 `levers` (8.1),
`flexible_teeth`, `spread_force`, `backlash`, `damage` and `heavy_shafts`. What a map says is read in `map_readings`.
"""
