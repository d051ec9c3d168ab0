"""Exploration: search, reset distribution, reverse curriculum and self-imitation."""
