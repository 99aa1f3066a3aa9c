"""Timings of facegear against the dissertation's rule and general-purpose integrators."""
