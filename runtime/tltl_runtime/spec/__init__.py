"""A spec ready for episodes: its task, and wrappers that judge and reward episodes by it.

For one environment, begin with :mod:`~tltl_runtime.spec.wrapper`; for many automata at once, with
:mod:`~tltl_runtime.spec.batch.monitor`.
"""
