"""What the targets that draw share: texts for pictures, and the layout in a child process."""
