"""SymPy derivations, one module a subject, and their lambdified twins; nothing is derived at import.

Meshing and moment arm (chapters 3 and 7), modal equations of the disk (4), plane field and its stiffness (6), torsional
equations (7), averaging (2). Chapters show the steps, the other packages use the results; no name is public.
"""
