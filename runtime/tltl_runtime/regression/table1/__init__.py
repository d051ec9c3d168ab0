"""Table I of the paper, measured on the levels of this package."""
