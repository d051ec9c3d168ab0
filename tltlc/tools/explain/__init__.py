"""Explain specs in plain words.

An explanation has what the spec asks for, the states of its automaton, and the shortest traces that
succeed and that fail.
"""
