"""Artefacts as JSON: the schema, the validator generated from it, encoding, decoding and consistency checks."""
