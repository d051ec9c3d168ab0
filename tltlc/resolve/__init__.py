"""From a syntax tree to specs: imports, names, types, units, predicates, formulas."""
