"""Read level files, check them, and apply overlays. Begin with `file`."""
