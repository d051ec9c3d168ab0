"""Turn a syntax tree into specs: load imports, look up names, check types and units, build formulas."""
