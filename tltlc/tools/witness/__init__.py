"""Find traces that show what a spec means, as ``test`` blocks or as samples of signals.

These are a shortest accepted trace, a shortest rejected trace, or traces that take every edge.
"""
