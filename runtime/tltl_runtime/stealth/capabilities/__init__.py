"""Check whether a level supplies what a spec uses, and what a player can reach in the level.

`capabilities` does the first check, and `feasible` the second.
"""
