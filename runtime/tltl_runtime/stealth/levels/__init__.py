"""Level files: read, checked, and changed by overlays."""
