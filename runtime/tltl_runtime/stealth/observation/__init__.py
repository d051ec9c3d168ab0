"""What the agent senses."""
