"""The enemies: their perception, their behaviour and their motion."""
