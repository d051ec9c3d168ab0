"""Formulas become automata: diagrams, minimal machines, guards, distances, labels."""
