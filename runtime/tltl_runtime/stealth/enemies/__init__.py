"""The enemies: what they see, decide and do. Begin with `enemy`."""
