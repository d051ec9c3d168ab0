"""Arithmetic over signals and params: its tree, evaluation, JSON and Python."""
