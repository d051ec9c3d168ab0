"""Suites of regression tests: the file format, the dependencies of cases, and the cache of results."""
