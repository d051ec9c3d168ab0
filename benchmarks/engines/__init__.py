"""Monitors in the languages of engines, generated and written by hand: one module per language, with ``ENGINES``.

A module is found by its place alone.  Beside it stand a driver (``drivers/LANGUAGE``), which steps both monitors over a
trace, and what is written by hand (``benchmarks/handwritten/LANGUAGE``).
"""
