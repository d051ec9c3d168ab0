"""Regression tests: suites of cases, verdicts by statistics, explanations and reports."""
