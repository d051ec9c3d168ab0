"""The game in a window. Begin with `window`."""
