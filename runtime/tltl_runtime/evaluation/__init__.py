"""Evaluate policies: play reproducible episodes, and compute their statistics.

Begin with :mod:`~tltl_runtime.evaluation.evaluate`.
"""
