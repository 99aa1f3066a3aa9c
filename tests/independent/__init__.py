"""Routes to the same numbers that share no code with the package: the anchors of the reference arrays."""
