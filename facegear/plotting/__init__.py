"""Figures of the book. Nothing here computes: every function draws arrays that it is given."""
