"""Propose specs from recorded traces.

Templates and sequences are counted with bit masks and confirmed by automata.
"""
