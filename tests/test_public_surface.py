"""What users of tltlc rely on is as ``public_surface.txt`` lists it.

``UPDATE_GOLDEN=1`` in the environment rewrites the list; review the changes: a line that disappears breaks somebody's
code, script or file.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import click
import pytest

import tltlc
from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.command_line import BUILT_IN, CommandLine

ROOT = Path(__file__).parents[1]
GOLDEN = Path(__file__).with_name("public_surface.txt")

FORMATS = {
    "artefact": "tltlc/artefact/encode.py",
    "conformance corpus": "tltlc/tools/conformance/corpus.py",
    "tape": "tltlc/monitor/tapes.py",
    "policy": "runtime/tltl_runtime/policies/file.py",
    "episode": "runtime/tltl_runtime/stealth/recordings/file.py",
    "episode of a scene": "runtime/tltl_runtime/gymnasium_games/scene_episode_file.py",
    "baseline": "runtime/tltl_runtime/regression/verdict/baseline.py",
    "report of a regression run": "runtime/tltl_runtime/regression/report/report_json.py",
    "cached result of a regression case": "runtime/tltl_runtime/regression/suite_run.py",
    "cached result of retraining": "runtime/tltl_runtime/regression/retrain/retrain.py",
    "checkpoint of a training": "runtime/tltl_runtime/training/files/checkpoint.py",
    "record of a training": "runtime/tltl_runtime/training/files/record.py",
    "ways of a search": "runtime/tltl_runtime/training/files/found_ways.py",
    "settings of a run": "runtime/tltl_runtime/training/files/run_file.py",
    "protocol of games in other processes": "runtime/tltl_runtime/wire/hello.py",
}
"""The file formats and protocols that have versions, with the modules that state them."""

_VERSION = re.compile(r"^_?VERSION(?:: Final)? = ([0-9]+)$", re.MULTILINE)
_IMPORT = re.compile(r"^ *(?:>>> )?from (tltl(?:c|_runtime)(?:\.\w+)*) import ([\w, ]+)", re.MULTILINE)
_DOTTED = re.compile(r"\btltl(?:c|_runtime)(?:\.\w+)+\b(?!/)")


def test_the_public_surface_is_as_listed() -> None:
    pytest.importorskip("gymnasium")
    text = "\n".join(line for title, lines in sections() for line in (f"# {title}", *lines, ""))
    if os.environ.get("UPDATE_GOLDEN") == "1":
        GOLDEN.write_text(text, encoding="utf-8")
    assert text == GOLDEN.read_text(encoding="utf-8")


def test_each_version_of_a_file_format_is_listed() -> None:
    folders = ("tltlc", "runtime/tltl_runtime")
    modules = (path for folder in folders for path in (ROOT / folder).rglob("*.py"))
    stated = {path.relative_to(ROOT).as_posix() for path in modules if _VERSION.search(path.read_text("utf-8"))}
    assert stated == set(FORMATS.values())


def test_each_module_that_the_documentation_mentions_exists() -> None:
    pytest.importorskip("gymnasium")
    modules = [line.partition(":")[0] for line in documented_names()]
    assert [module for module in modules if not is_module(module)] == []


def sections() -> Iterator[tuple[str, list[str]]]:
    runtime = import_module("tltl_runtime")
    yield "Names of tltlc", sorted(tltlc.__all__)
    yield "Names of tltl_runtime", sorted(runtime.__all__)
    yield "Names in other modules that the documentation mentions", list(documented_names())
    yield "Names of tltlc.api, the façade of the compiler", list(facade_names())
    yield "Commands", [line for name, command in commands() for line in command_lines(name, command)]
    statuses = {name: value for name, value in vars(exits).items() if name.isupper() and isinstance(value, int)}
    yield "Exit statuses", [f"{value} {name}" for name, value in statuses.items()]
    yield "Environments of Gymnasium", sorted(name for name in import_module("gymnasium").registry if "tltl/" in name)
    yield "Versions of file formats", [f"{name}: {version(module)}" for name, module in FORMATS.items()]


# --- Python names ---------------------------------------------------------------------------------


def documented_names() -> Iterator[str]:
    """Yield ``MODULE: NAME, …`` for each module that the README or a page of the documentation names."""
    names: dict[str, set[str]] = {}
    for page in (ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "docs" / "guides").glob("*.md")):
        text = page.read_text(encoding="utf-8")
        for module, imported in _IMPORT.findall(text):
            names.setdefault(module, set()).update(name.split(" as ")[0].strip() for name in imported.split(","))
        for dotted in _DOTTED.findall(text):
            module, name = split(dotted)
            names.setdefault(module, set()).update([name] if name else [])
    for module in sorted(names.keys() - {"tltlc", "tltl_runtime"}):
        yield f"{module}: {', '.join(sorted(names[module]))}".rstrip(": ")


def facade_names() -> Iterator[str]:
    """Yield the façade's names, then ``MODULE: NAME, …`` for each of its modules."""
    facade = import_module("tltlc.api")
    modules = [name for name in facade.__all__ if is_module(f"tltlc.api.{name}")]
    yield ", ".join(sorted(set(facade.__all__) - set(modules)))
    for name in modules:
        yield f"{name}: {', '.join(import_module(f'tltlc.api.{name}').__all__)}"


def split(dotted: str) -> tuple[str, str]:
    """Split a dotted name into its module and the first name in that module, which may be empty."""
    parts = dotted.split(".")
    count = 1
    while count < len(parts) and is_module(".".join(parts[: count + 1])):
        count += 1
    return ".".join(parts[:count]), "".join(parts[count : count + 1])


def is_module(name: str) -> bool:
    try:
        return find_spec(name) is not None
    except ModuleNotFoundError:
        return False


# --- commands -------------------------------------------------------------------------------------


def commands() -> Iterator[tuple[str, click.Command]]:
    """Yield the commands in the order of the help text, those of the runtime last."""
    group = CommandLine("tltlc")
    context = click.Context(group)
    for name in BUILT_IN:
        command = group.get_command(context, name)
        assert command is not None
        yield name, command
    for name, entry in sorted(project()["entry-points"]["tltlc.commands"].items()):
        module, attribute = entry.split(" [")[0].split(":")
        yield name, getattr(import_module(module), attribute)


def command_lines(name: str, command: click.Command) -> Iterator[str]:
    yield f"tltlc {name} {' '.join(argument_text(param) for param in command.params if is_argument(param))}".rstrip()
    for param in command.params:
        if not is_argument(param):
            yield f"    {option_text(param)}"


def is_argument(param: click.Parameter) -> bool:
    return isinstance(param, click.Argument)


def argument_text(param: click.Parameter) -> str:
    return (param.metavar or (param.name or "").upper()) + choices(param)


def choices(param: click.Parameter) -> str:
    return f" {{{','.join(map(str, param.type.choices))}}}" if isinstance(param.type, click.Choice) else ""


def option_text(param: click.Parameter) -> str:
    assert isinstance(param, click.Option)
    names = ", ".join([*param.opts, *param.secondary_opts])
    value = "" if param.is_flag else choices(param) or f" {param.metavar or param.type.name.upper()}"
    return f"{names}{value}{' ...' if param.multiple else ''}"


def project() -> dict[str, dict[str, dict[str, str]]]:
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    table: dict[str, dict[str, dict[str, str]]] = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    return table


# --- numbers --------------------------------------------------------------------------------------


def version(module: str) -> int:
    match = _VERSION.search((ROOT / module).read_text(encoding="utf-8"))
    assert match is not None, module
    return int(match[1])
