"""The physics of the game: the bodies of a level, and the motion of the player."""
