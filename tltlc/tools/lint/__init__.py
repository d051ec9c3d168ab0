"""Remarks on specs that compile and yet may not say what was meant, some of them with a fix.

A rule is a module in :mod:`tltlc.tools.lint.rules`, found by its place there.
"""
