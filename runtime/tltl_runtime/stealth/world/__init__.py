"""The bodies of a level in the physics, and what the player's can do."""
