"""Policies: the networks, their files, and the cards that describe their training."""
