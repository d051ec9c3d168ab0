"""Verdicts: the baselines with the texts of their levels, how cases are played, and the statistics."""
