"""Deterministic Rabin automata of formulas over infinite traces (semantics, section 5)."""
