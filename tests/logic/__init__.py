"""Tests of the formulas, their laws and their texts."""
