"""PPO: the runner, the policy, the environments and the weights of penalties."""
