"""Code shared by the monitors for all versions of Godot."""
