"""Specs proposed from recorded traces: templates and sequences, counted by bit masks, confirmed by automata."""
