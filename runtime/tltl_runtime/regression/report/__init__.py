"""Reports: JSON, JUnit, GitHub annotations and the HTML page."""
