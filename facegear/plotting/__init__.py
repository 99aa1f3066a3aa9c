"""Figures that any user draws. Nothing here computes: every function draws arrays that it is given.

One look for all (`style`), mode shapes (`modes`), the figures of a report (`report`), views that turn and sliders
(`interactive`).
"""
