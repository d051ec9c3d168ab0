"""Explanations: what a policy does differently from the baseline.

Begin with :mod:`~tltl_runtime.regression.explain.explain`.
"""
