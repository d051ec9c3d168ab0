"""Play episodes by a spec: tasks, and wrappers that judge and reward episodes.

For one environment, begin with :mod:`~tltl_runtime.spec.wrapper`; for many automata at once, with
:mod:`~tltl_runtime.spec.batch.monitor`.
"""
