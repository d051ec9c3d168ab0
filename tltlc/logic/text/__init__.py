"""Formulas as text: three notations and English."""
