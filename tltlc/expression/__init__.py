"""Arithmetic over signals and params: syntax trees, their evaluation, and their conversion to JSON and Python."""
