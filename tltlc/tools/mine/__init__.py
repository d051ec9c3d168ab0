"""Propose specs that recorded traces satisfy and counterexamples do not.

Candidate clauses are tested on all traces at once, with bit masks. The best specs are then compiled,
and their automata judge all traces again.
"""
