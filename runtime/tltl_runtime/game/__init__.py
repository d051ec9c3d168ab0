"""A game as training, evaluation and regression see it.

It has levels, environments, recordings and an expert. Begin with :mod:`~tltl_runtime.game.game`.
"""
