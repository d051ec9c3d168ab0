"""Pictures of the game: plans, frames and films."""
