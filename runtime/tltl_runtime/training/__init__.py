"""Train agents with rsl-rl's PPO.

Begin with :mod:`~tltl_runtime.training.run.train`.
"""
