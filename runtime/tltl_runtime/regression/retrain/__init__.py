"""Training on the levels that no longer pass."""
