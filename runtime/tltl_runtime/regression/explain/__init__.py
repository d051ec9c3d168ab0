"""Explanations: what a policy does differently from its baseline."""
