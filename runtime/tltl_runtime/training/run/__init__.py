"""A training as a whole: settings, checkpoints, records."""
