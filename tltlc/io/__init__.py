"""Files, limits and the project file: all access to the operating system."""
