"""The reports on a suite: JSON, JUnit, GitHub annotations and an HTML page."""
