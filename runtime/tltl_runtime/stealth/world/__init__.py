"""The physics: the bodies of a level, and the motion of the player. Begin with `physics`."""
