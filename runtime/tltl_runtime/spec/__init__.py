"""Judge and reward episodes by a spec, in one environment or in many at once.

For one environment, begin with :mod:`~tltl_runtime.spec.wrapper`; for many automata at once, with
:mod:`~tltl_runtime.spec.batch.monitor`.
"""
