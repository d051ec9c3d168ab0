"""Convert automata to artefacts (JSON files) and back, and check artefacts. Begin with `encode` and `decode`."""
