"""Convert observations and actions of all supported spaces to arrays for a network, and back.

Begin with :mod:`~tltl_runtime.policies.spaces.layouts`.
"""
