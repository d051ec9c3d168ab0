"""Policies: the networks that play, the files that hold them, and what they were trained for."""
