"""Evaluations of policies: reproducible episodes and their statistics.

Begin with :mod:`~tltl_runtime.evaluation.evaluate`.
"""
