"""Baselines, the play of cases, and the statistics of verdicts.

Begin with :mod:`~tltl_runtime.regression.verdict.suite_run`.
"""
