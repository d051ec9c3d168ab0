"""Artefacts as JSON: write them, check them and read them. Begin with `encode` and `decode`."""
