"""Baselines, the play of cases, and the statistics of verdicts."""
