"""The components of PPO: environments, policies, scheduled weights, random streams and processes.

The learning loop is in :mod:`~tltl_runtime.training.runner`.
"""
