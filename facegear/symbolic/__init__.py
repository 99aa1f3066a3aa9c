"""SymPy derivations, one module a subject, and their NumPy twins; nothing is derived at import.

Meshing (`meshing`; chapter 3), contact at a point (`point_contact`; 3) and moment arm (`arm`; 3, 7), modal equations of
the disk (`galerkin`; 4), its plane field (`inplane`; 6) by Lamé's potentials (`lame`) and at rest by Michell's solution
(`michell`), both of terms that hold its edges (`edge_terms`), the stiffness that follows (`edge_stiffness`; 6),
torsional equations (`torsional`; 7), averaging (`hsu`; 2) and its criterion (`criterion`; 2, 7). Chapters show the
steps, the other packages use the results; no name is public. What is computed with of meshing and averaging stands in
`twins`, which `make twins` writes from the derivations.
"""
