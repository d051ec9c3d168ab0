"""Artefacts as JSON: their schema, the validator generated from it, writing, reading and checking."""
