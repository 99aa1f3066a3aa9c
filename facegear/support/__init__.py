"""What everything stands on and what knows nothing of gears.

Checked inputs and units at the edges (`parameters`), kinds of objects (`kinds`), types of arrays (`types`), roots
(`roots`), nodes and weights of integrals (`quadrature`), threads of BLAS (`threads`), labelled arrays and their files
(`labelled`), CSV (`tables`), files that appear whole (`files`), the part of YAML that people write by hand
(`plain_yaml`), which version and commit made a file (`provenance`).
Public: `rad_per_s`, `rpm`, `watt`.
"""
