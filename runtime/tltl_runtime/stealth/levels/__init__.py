"""Read level files, check them, and apply overlays."""
