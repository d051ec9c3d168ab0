"""The reports on a suite: their sentences and figures, and their formats: JSON, JUnit, GitHub annotations, HTML."""
