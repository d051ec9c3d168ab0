"""Policies: their networks, their files, and the cards that describe their training.

Begin with :mod:`~tltl_runtime.policies.policy`.
"""
