"""Stability of face-gear drives."""
