"""The stealth game in a window. Begin with `screen`."""
