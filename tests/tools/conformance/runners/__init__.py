"""One module per language; each defines ``RUNNERS``, and ``runners()`` imports all of them."""
