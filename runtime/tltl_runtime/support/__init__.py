"""Helpers that do not depend on any game: file formats, worker processes, hashes, and texts for messages."""
