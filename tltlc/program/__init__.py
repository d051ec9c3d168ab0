"""A monitor as a program of no language: declarations, assignments and branches, which backends print."""
