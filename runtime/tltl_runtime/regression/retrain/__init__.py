"""The retraining of policies whose cases no longer pass."""
