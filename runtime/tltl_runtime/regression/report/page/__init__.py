"""The report on a suite as a page: one HTML file that loads nothing."""
