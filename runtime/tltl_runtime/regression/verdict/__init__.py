"""Baselines with the texts of their levels, the play of cases, and the statistics of verdicts."""
