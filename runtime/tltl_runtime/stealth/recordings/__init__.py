"""Recorded episodes: their files, checks and summaries."""
