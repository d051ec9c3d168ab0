"""Specs in plain words: what is asked for, the states of the automaton, the shortest ways to succeed and to fail."""
