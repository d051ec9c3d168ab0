"""Helpers that are independent of games: formats, processes, hashes."""
