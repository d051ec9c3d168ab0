"""Comparisons with peers, each a ratio measured in one run: ``python -m benchmarks`` (or ``make bench``)."""
