"""The tools over compiled specs: lint, fmt, explain, diff, witness, mine, conformance, hoa."""
