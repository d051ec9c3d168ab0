"""The lint rules. Every module in this folder is a rule and defines ``RULE``."""

from __future__ import annotations

import os
from functools import lru_cache
from importlib import import_module

from tltlc.tools.lint.rule import LintRule


@lru_cache(maxsize=1)
def rules() -> tuple[LintRule, ...]:
    """Return all rules, sorted by code."""
    names = sorted(name[:-3] for name in os.listdir(os.path.dirname(__file__)) if name.endswith(".py"))  # noqa: PTH120, PTH208
    all_rules: list[LintRule] = [import_module(f"{__name__}.{name}").RULE for name in names if not name.startswith("_")]
    return tuple(sorted(all_rules, key=lambda rule: rule.code))
