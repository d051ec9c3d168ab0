"""Explain syntax errors: guess what the text was meant to say, and suggest fixes."""
