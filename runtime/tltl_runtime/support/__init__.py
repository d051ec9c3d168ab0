"""Helpers that are not about games: formats, processes, hashes."""
