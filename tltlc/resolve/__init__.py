"""Resolve a syntax tree into specs: imports, names, types, units, predicates, formulas."""
