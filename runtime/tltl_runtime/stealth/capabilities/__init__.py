"""What a level has for a spec, and what a player can reach there at all."""
