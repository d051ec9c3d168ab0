"""Check what a level supplies to a spec, and what a player can reach in the level.

`capabilities` checks the supply, and `feasible` what can be reached.
"""
