"""The observations of the agent. Begin with `observation`."""
