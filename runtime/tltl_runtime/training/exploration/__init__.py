"""Exploration: search, reset distributions and self-imitation."""
