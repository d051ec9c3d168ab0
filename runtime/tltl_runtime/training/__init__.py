"""Training of agents by PPO of rsl-rl."""
