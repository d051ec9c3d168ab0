"""The façade: what programs that build on the compiler import."""

import ast
from importlib import import_module
from pathlib import Path

import pytest

from tltlc import api

RUNTIME = Path(__file__).parents[1] / "runtime" / "tltl_runtime"
MODULES = ("cli", "compiler", "expressions", "fileio", "monitors", "ranges", "specs", "syntax", "traces")


def test_the_facade_has_few_names() -> None:
    assert len({*api.__all__} - {*MODULES}) <= 25


@pytest.mark.parametrize("name", api.__all__)
def test_each_name_of_the_facade_loads(name: str) -> None:
    if name in MODULES:
        import_module(f"tltlc.api.{name}")
    assert getattr(api, name) is not None


@pytest.mark.parametrize("name", MODULES)
def test_each_module_of_the_facade_lists_its_names(name: str) -> None:
    module = import_module(f"tltlc.api.{name}")
    missing = [listed for listed in module.__all__ if not hasattr(module, listed)]
    assert not missing


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = api.nothing


def test_the_runtime_uses_every_name_of_the_facade_and_nothing_else_of_the_compiler() -> None:
    used, deep = set(), []
    for file in sorted(RUNTIME.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module == "tltlc.api":
                used |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("tltlc."):
                deep.append(f"{file.name}:{node.lineno}")
    assert not deep
    assert used == set(api.__all__)
