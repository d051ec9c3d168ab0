"""Verdicts of regression tests: record and read baselines, play cases, and judge the episodes."""
