"""Figures of the chapters. Nothing here computes: every function draws arrays that it is given."""
