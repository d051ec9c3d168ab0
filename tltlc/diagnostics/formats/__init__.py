"""The formats of diagnostics, each a module with a function ``render``."""
