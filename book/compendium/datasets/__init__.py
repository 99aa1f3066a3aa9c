"""Arrays of the figures of the chapters, labelled, with units and the tolerances at which they are checked."""
