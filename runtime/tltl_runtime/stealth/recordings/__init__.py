"""Recorded episodes: their files, checks and summaries. Begin with `episode`."""
