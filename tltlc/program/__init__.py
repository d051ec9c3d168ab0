"""Language-independent monitor programs: declarations, assignments and branches, which backends print."""
