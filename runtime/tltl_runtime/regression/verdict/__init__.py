"""Baselines, play, and the statistics of verdicts."""
