"""Monitors as programs in no particular language, which backends print in languages such as C.

A program has declarations, assignments and branches.
"""
