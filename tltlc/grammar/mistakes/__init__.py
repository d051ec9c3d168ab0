"""Guesses at what a text with syntax errors was meant to say."""
