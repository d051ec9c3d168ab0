"""What a level supplies to a spec, and what a player can reach in it."""
