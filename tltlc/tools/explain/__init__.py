"""Explain specs in plain words.

An explanation says what a spec asks for, lists the states of its automaton, and shows a shortest
trace that succeeds and one that fails.
"""
