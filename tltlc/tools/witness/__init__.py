"""Find traces that show what a spec means, as ``test`` blocks or as samples of signals.

The traces are shortest ones, or together take every edge.
"""
