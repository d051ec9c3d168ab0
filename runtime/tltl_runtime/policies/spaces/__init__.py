"""Observations and actions of any game as arrays for a network.

Begin with :mod:`~tltl_runtime.policies.spaces.layouts`.
"""
