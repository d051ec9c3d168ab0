"""A scripted player that completes levels. Begin with `expert`."""
