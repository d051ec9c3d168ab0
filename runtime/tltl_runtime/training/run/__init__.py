"""A whole training: settings, checkpoints, records.

Begin with :mod:`~tltl_runtime.training.run.train`.
"""
