"""Compare versions of specs: the traces they accept, and other changes that a host would notice."""
