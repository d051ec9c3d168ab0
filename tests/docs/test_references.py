"""The names that docstrings refer to, such as ``:func:`reward_step```, exist."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from tests.docs.blocks import ROOT

ROLE = re.compile(r":(?:mod|func|class|meth|data|attr|exc):`~?\.?([\w.]+)`")
ROOTS = {"tltlc": ROOT / "tltlc", "tltl_runtime": ROOT / "runtime" / "tltl_runtime"}
OTHERS = {*sys.stdlib_module_names, "gymnasium", "torch", "numpy", "click", "tensordict", "rsl_rl"}
MODULES = sorted(path for folder in ROOTS.values() for path in folder.rglob("*.py") if ":`" in path.read_text("utf-8"))


def module_path(parts: tuple[str, ...]) -> Path | None:
    """Return the file of a module, given the parts of its name, or None if there is no such module."""
    base = ROOTS[parts[0]].joinpath(*parts[1:])
    return next((path for path in (base.with_suffix(".py"), base / "__init__.py") if path.is_file()), None)


@cache
def names_in(path: Path) -> frozenset[str]:
    """Return the names that a module defines or imports, and those of its classes: ``Class.method``."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return frozenset(names_of(tree.body, ""))


@cache
def imported_from(path: Path) -> dict[str, str]:
    """Return, for each name that a module imports from another module of the project, the name of that module."""
    imports = (node for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.ImportFrom))
    ours = [node for node in imports if node.module and node.module.split(".")[0] in ROOTS]
    return {alias.name: node.module or "" for node in ours for alias in node.names}


def names_of(body: list[ast.stmt], prefix: str) -> Iterator[str]:
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield f"{prefix}{node.name}"
            assigned = (target for target in ast.walk(node) if isinstance(target, ast.Attribute))
            yield from (f"{prefix}{target.attr}" for target in assigned if isinstance(target.ctx, ast.Store))
        elif isinstance(node, ast.ClassDef):
            yield f"{prefix}{node.name}"
            yield from names_of(node.body, f"{prefix}{node.name}.")
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            yield from (f"{prefix}{alias.asname or alias.name}" for alias in node.names)
        elif isinstance(node, (ast.If, ast.Try, ast.With)):
            yield from names_of([*node.body, *getattr(node, "orelse", ())], prefix)
        else:
            stored = (name for name in ast.walk(node) if isinstance(name, ast.Name))
            yield from (f"{prefix}{name.id}" for name in stored if isinstance(name.ctx, ast.Store))


def exists(reference: str, path: Path) -> bool:
    """Whether a reference in a module names something there or in another module of the project."""
    parts = tuple(reference.split("."))
    if parts[0] not in ROOTS:
        # A name of this module; `name` alone may also be an attribute of one of its classes.
        names = names_in(path)
        source = imported_from(path).get(parts[0])
        if source and len(parts) > 1:
            return exists(f"{source}.{reference}", path)
        return reference in names or any(name.endswith(f".{reference}") for name in names)
    for length in range(len(parts), 0, -1):
        module = module_path(parts[:length])
        if module is not None:
            rest = ".".join(parts[length:])
            first = parts[length] if rest else ""
            if "." in rest and first in imported_from(module):
                return exists(f"{imported_from(module)[first]}.{rest}", path)
            return not rest or rest in names_in(module)
    return False


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_references_exist(path: Path) -> None:
    references = ROLE.findall(path.read_text(encoding="utf-8"))
    missing = [name for name in references if name.split(".")[0] not in OTHERS and not exists(name, path)]
    assert not missing


def test_a_reference_to_a_renamed_module_is_reported() -> None:
    module = ROOT / "tltlc" / "pipeline.py"
    assert exists("tltlc.monitor.progress_and_reward.Mode", module)
    assert not exists("tltlc.monitor.reward.Mode", module)
    assert not exists("tltlc.monitor.progress_and_reward.Modes", module)
    assert exists("Session.compiled", module) and not exists("Session.result_of", module)
