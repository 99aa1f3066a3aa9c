"""Where a model is unstable: maps over two parameters, and tongues found however narrow.

`stability_map` goes over its `axes` in one of the `ways`: by columns (`map_columns`) or sheets of them (`map_sheets`),
by `rows`, or from cell to cell (`cells`), as the systems of a `sweep` have in common (`likeness`). `tracing` finds
tongues in the `scans` of `scanning`, which looks at all `meetings` of multipliers; values of a parameter at which one
closes are in `closing`, tips in which one ends in `lobes`, the largest growth rate and where it vanishes in `peaks`,
derivatives in `sensitivity` and `exponents`. `campbell` has natural motions over speed, `response_map` the steady
response to forces where the model is stable, with its `resonance_peaks`. Work is shared out over processes, and kept
on disk, by `parallel` and its `crew`.
Public: `stability_map`, `tongues`, `frequency_response`, `response_map`.
"""
