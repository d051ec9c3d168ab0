"""Files, limits and the project file: everything that touches the system."""
