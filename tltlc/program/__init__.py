"""Monitors as programs in no particular language: declarations, assignments and branches, which backends print."""
