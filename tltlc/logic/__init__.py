"""Formulas: what they are, what they mean, how they are rewritten and printed."""
