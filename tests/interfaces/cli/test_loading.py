"""The modules that a command imports. Heavy ones are forbidden, because every run pays for its
start."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import EXAMPLE, ROOT
from tests.waiting import HANG_S

HEAVY = {
    "sympy", "networkx", "graphviz", "pygraphviz", "rich", "lark", "jsonschema", "fastjsonschema", "numpy", "torch",
    "importlib.metadata", "asyncio", "http", "xml", "multiprocessing", "unittest",
    "mcp", "anyio", "pydantic",
}  # fmt: skip


def loaded_modules(*arguments: str | Path, folder: Path) -> set[str]:
    """Return the modules that are loaded at the end of a command."""
    program = (
        "import sys, atexit\n"
        "atexit.register(lambda: sys.stdout.write('\\nMODULES ' + ' '.join(sys.modules)))\n"
        f"sys.path.insert(0, {str(ROOT)!r})\n"
        "from tltlc.interfaces.cli.main import main\n"
        "main(sys.argv[1:])\n"
    )
    completed = subprocess.run(
        [sys.executable, "-c", program, *map(str, arguments)],
        capture_output=True,
        cwd=folder,
        timeout=HANG_S,
        check=True,
        # The first run fills the cache of predicate checks.
        env={**os.environ, "XDG_CACHE_HOME": str(folder / "cache")},
    )
    return set(completed.stdout.decode().rpartition("\nMODULES ")[2].split())


@pytest.fixture(scope="module")
def checked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder whose cache holds the checks of the example's predicates."""
    folder = tmp_path_factory.mktemp("checked")
    loaded_modules("check", EXAMPLE, folder=folder)
    return folder


@pytest.mark.parametrize(
    "arguments",
    [
        ("compile", EXAMPLE),
        ("check", EXAMPLE),
        ("lint", EXAMPLE),
        ("--help",),
        ("--version",),
        ("list", "codes"),
        ("explain", "TLT0001"),
        ("explain", EXAMPLE),
        ("witness", EXAMPLE),
    ],
    ids=lambda arguments: arguments[0],
)
def test_no_heavy_module_is_imported(arguments: tuple[str | Path, ...], checked: Path) -> None:
    # The target `dot` is a default target, and it uses graphviz.
    written = {"graphviz"} if arguments[0] == "compile" else set()
    assert not loaded_modules(*arguments, folder=checked) & HEAVY - written


def test_only_infinite_specs_load_the_modules_for_them(tmp_path: Path) -> None:
    def infinite_modules(*arguments: str | Path) -> set[str]:
        return {
            name for name in loaded_modules(*arguments, folder=tmp_path) if name.startswith("tltlc.automaton.infinite")
        }

    assert not infinite_modules("compile", EXAMPLE, "-t", "json,python,dot")
    assert not infinite_modules("compile", "cover_and_hide.fspa.json", "-t", "mermaid")
    assert not infinite_modules("explain", EXAMPLE)
    # Strongly connected components are computed for any graph.
    assert infinite_modules("witness", EXAMPLE) == {"tltlc.automaton.infinite", "tltlc.automaton.infinite.graphs"}
    endless = tmp_path / "again.tltl"
    endless.write_text("signal a: bool\nspec again { semantics infinite  require G F a }\n", encoding="utf-8")
    assert "tltlc.automaton.infinite.construct" in infinite_modules("compile", endless, "-t", "json")
    # An artefact is checked; nothing is constructed.
    assert "tltlc.automaton.infinite.cycles" in infinite_modules("compile", "again.fspa.json", "-t", "mermaid")
    assert "tltlc.automaton.infinite.construct" not in infinite_modules("compile", "again.fspa.json", "-t", "mermaid")


def test_help_loads_no_command_and_no_compiler(tmp_path: Path) -> None:
    modules = {name for name in loaded_modules("--help", folder=tmp_path) if name.startswith("tltlc")}
    line = {
        "tltlc",
        "tltlc.interfaces.cli",
        "tltlc.interfaces.cli.main",
        "tltlc.interfaces.cli.command_line",
        "tltlc.interfaces.cli.exits",
        "tltlc.interfaces.cli.interrupts",
        "tltlc.interfaces.cli.numbers",
        "tltlc.interfaces.cli.plugins",
    }
    shared = {
        "tltlc.interfaces",
        "tltlc.core",
        "tltlc.io",
        "tltlc.io.limits",
        "tltlc.io.resources",
        "tltlc.diagnostics",
        "tltlc.diagnostics.diagnostic",
        "tltlc.core.record",
        "tltlc.core.source",
    }
    assert modules <= line | shared


def test_the_package_imports_no_module(tmp_path: Path) -> None:
    program = "import sys; sys.path.insert(0, sys.argv[1]); import tltlc; print(*sys.modules)"
    completed = subprocess.run([sys.executable, "-c", program, str(ROOT)], capture_output=True, check=True, text=True)
    assert {name for name in completed.stdout.split() if name.startswith("tltlc")} == {"tltlc"}


def test_the_package_exports_what_it_lists() -> None:
    import tltlc

    for name in tltlc.__all__:
        assert getattr(tltlc, name) is not None
        assert name in dir(tltlc)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        tltlc.nonsense  # type: ignore[attr-defined] # noqa: B018
