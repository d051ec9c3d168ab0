"""Regression tests: do trained policies still meet their specs on changed levels?

Begin with :mod:`~tltl_runtime.regression.suite_run`.
"""
