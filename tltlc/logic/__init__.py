"""Formulas: their structure, semantics, rewrites and printed forms."""
