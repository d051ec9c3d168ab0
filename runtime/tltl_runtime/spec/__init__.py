"""Judge and reward episodes by a spec: tasks, wrappers of environments, and batches of automata.

For one environment, begin with :mod:`~tltl_runtime.spec.wrapper`; for many automata at once, with
:mod:`~tltl_runtime.spec.batch.monitor`.
"""
