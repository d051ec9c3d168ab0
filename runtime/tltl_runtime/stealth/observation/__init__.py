"""The observations of the agent."""
