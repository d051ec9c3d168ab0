"""Automata from formulas: diagrams, minimal machines, guards, distances and labels."""
