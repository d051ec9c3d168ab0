"""A whole training: its preparation, its loop, its searches and its end.

Begin with :mod:`~tltl_runtime.training.run.train`.
"""
