"""SymPy derivations, one module a subject, and their NumPy twins; nothing is derived at import.

Meshing and moment arm (chapters 3 and 7), modal equations of the disk (4), plane field and its stiffness (6), torsional
equations (7), averaging (2). Chapters show the steps, the other packages use the results; no name is public. What is
computed with of meshing and averaging stands in `twins`, which `make twins` writes from the derivations.
"""
