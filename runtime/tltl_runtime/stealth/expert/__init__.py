"""A scripted player that finishes levels. Begin with `expert`."""
