"""Lint rules for specs that compile but may not mean what their author intended.

Each rule is a module in :mod:`tltlc.tools.lint.rules`. :mod:`tltlc.tools.lint.run` runs them.
"""
