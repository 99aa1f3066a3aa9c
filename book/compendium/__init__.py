"""What only the book needs: datasets and tolerances of each chapter's figures, their drawings, printed values.

`datasets` compute the figures of the chapters, `plotting` draws them; `reference` and `checks` compare them
with what is stored and with anchors, `validation` lists them beside values from outside; `printed` and `contents` hold
what the dissertation prints and the verdict on it, which `ledger_tables` show, long names `breakable`.
A notebook hands both to its `chapter`, and is done when that has compared them.
It is a user of `facegear` like any other, importable in the development install, and not part of the wheel.
"""
