"""One module per format of diagnostics, each with a function ``render``."""
