"""Retraining of policies on levels whose cases no longer pass."""
