"""Compare tltlc with peers, by ratios that are measured in one run: ``python -m benchmarks`` (or ``make bench``)."""
