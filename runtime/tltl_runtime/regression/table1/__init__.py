"""Table I of the paper, measured with our levels."""
