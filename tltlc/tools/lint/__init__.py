"""Lint rules for specs that compile but may not mean what their author intended. Some have a fix.

Each rule is a module in :mod:`tltlc.tools.lint.rules`.
"""
