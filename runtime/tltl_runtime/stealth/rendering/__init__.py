"""Pictures of the game.

`render` draws frames, `film` makes films of them, and `plan` draws levels from above.
"""
