"""Code shared by the targets that draw: texts for pictures, and the layout in a child process."""
