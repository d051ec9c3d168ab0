"""The imitation baseline: behavioural cloning and GAIL."""
