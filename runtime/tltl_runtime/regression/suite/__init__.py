"""Suites: the file format, what cases depend on, and the cache of results."""
