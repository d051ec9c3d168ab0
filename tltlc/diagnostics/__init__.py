"""Diagnostics: errors, warnings and notes about source texts, and their output formats."""
