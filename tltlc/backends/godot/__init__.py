"""Code that the targets for all versions of Godot share."""
