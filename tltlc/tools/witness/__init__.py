"""Find traces that show what a spec means, as ``test`` blocks or as samples of signals.

They are a shortest accepted trace, a shortest rejected trace, or traces that together take every
edge of the automaton. Begin with :mod:`tltlc.tools.witness.traces`.
"""
