"""Diagnostics: errors, warnings and notes for users, and the formats in which they are shown."""
