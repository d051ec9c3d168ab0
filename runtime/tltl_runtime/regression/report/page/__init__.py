"""The report on a suite as one self-contained HTML file.

Begin with :mod:`~tltl_runtime.regression.report.page.page`.
"""
