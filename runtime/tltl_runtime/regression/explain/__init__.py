"""Explanations: what an agent does differently from its baseline."""
