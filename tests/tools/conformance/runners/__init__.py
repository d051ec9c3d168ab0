"""One module per language; each has ``RUNNERS``, and is found by its place alone."""
