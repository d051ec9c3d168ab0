"""Monitors of the three paper specs, written by hand: what a careful programmer would ship without a compiler."""
