"""A game as training, evaluation and regression see it.

A game has levels, environments, recordings and a scripted expert. Begin with
:mod:`~tltl_runtime.game.game`.
"""
