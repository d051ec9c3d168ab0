"""Compare tltlc with its peers, which are similar tools, by ratios that are measured in one run.

``python -m benchmarks`` or ``make bench`` measures them.
"""
