"""Deterministic Rabin automata of formulas over infinite traces (``docs/semantics.md``, "Infinite traces")."""
