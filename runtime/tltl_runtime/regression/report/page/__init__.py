"""The report on a suite as a page: one self-contained HTML file."""
