"""Propose specs from recorded traces.

Bit masks show in which traces each candidate clause holds. The best specs are then compiled, and
their automata judge all traces again.
"""
