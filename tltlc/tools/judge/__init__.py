"""Judge many recorded traces by a spec.

The results say which traces are accepted, and which clauses the others break or do not meet.
Begin with :mod:`tltlc.tools.judge.judge`.
"""
