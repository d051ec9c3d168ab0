"""Retrain the policies of regression tests that no longer pass."""
