"""Policies: their networks, their files, and their cards (metadata about task and training).

Begin with :mod:`~tltl_runtime.policies.policy`.
"""
