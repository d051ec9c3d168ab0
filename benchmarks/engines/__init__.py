"""Monitors in the languages of engines, generated and written by hand: one module per language, with ``ENGINES``.

Modules are found by their folder. Each has a driver (``drivers/LANGUAGE``), which steps both
monitors over a trace, and handwritten monitors (``benchmarks/handwritten/LANGUAGE``).
"""
