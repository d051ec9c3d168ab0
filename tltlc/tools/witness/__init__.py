"""Traces that show what a spec means: as ``test`` blocks, as samples of signals, shortest or covering every edge."""
