"""Explain in sentences what a policy does differently from the baseline, and how its episodes fail.

Begin with :mod:`~tltl_runtime.regression.explain.explain`.
"""
