"""Exploration: how a training finds episodes that meet the spec, and where its episodes begin.

Begin with :mod:`~tltl_runtime.training.exploration.search`.
"""
