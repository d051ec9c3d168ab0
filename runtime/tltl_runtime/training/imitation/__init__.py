"""The imitation baseline: behavioural cloning and GAIL.

Begin with :mod:`~tltl_runtime.training.imitation.gail`.
"""
