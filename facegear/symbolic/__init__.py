"""SymPy derivations, one module a subject; nothing is derived at import."""
