"""Training of agents by PPO of rsl-rl, and what becomes of them: policies, evaluations, exports."""
