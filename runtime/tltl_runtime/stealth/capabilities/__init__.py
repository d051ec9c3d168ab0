"""Check what a level supplies to a spec, and what a player can reach in the level.

`capabilities` checks what a spec uses, and `feasible` what can be reached.
"""
