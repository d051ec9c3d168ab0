"""Monitors as programs in no language: declarations, assignments and branches, which the backends print."""
