"""PPO: environments, policies, penalty weights, random streams and the processes of a training."""
