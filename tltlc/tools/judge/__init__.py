"""Judge many recorded traces by a spec: which are accepted, and which clauses the others break or leave undone.

Begin with :mod:`tltlc.tools.judge.judge`.
"""
