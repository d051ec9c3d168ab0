"""Enemies: what they see, decide and do."""
