"""The enemies: what they see, what they decide and what they do. Begin with `enemy`."""
