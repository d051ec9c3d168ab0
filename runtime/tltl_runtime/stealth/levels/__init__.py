"""Read level files, check them, and apply overlays (files with small changes). Begin with `file`."""
