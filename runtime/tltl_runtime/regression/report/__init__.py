"""The report on a suite of regression tests, and its formats: JSON, JUnit, GitHub annotations and HTML."""
