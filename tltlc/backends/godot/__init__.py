"""What monitors for Godot share, whatever the version of the engine."""
