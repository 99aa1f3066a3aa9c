"""Figures that any user draws. Nothing here computes: every function draws arrays that it is given.

One look for all (`style`), mode shapes (`modes`), natural frequencies over speed (`campbell`), contact patterns
(`contact_pattern`), motions of a gearbox with play (`motions`), the figures of a report and of an assessment (`report`,
`assessment`), views that turn, sliders and pictures in a page (`interactive`).
"""
