"""Evaluations of policies: reproducible episodes and their statistics."""
