"""Code that the targets for pictures share: the texts in pictures, and the layout in a child process."""
