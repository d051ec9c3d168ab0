"""Train agents with rsl-rl's PPO."""
