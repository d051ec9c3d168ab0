"""What a level supplies to a spec, and what a player can reach in it.

Begin with `capabilities` for the first and with `feasible` for the second.
"""
