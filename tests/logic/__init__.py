"""Tests of formulas, their laws and their texts."""
