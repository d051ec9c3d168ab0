"""``tltlc list``: list the available predicates, targets, games, levels or error codes."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import click

from tltlc.diagnostics.diagnostic import TltlError

ListRow = dict[str, str]

LISTS = "tltlc.lists"
"""The entry-point group for lists that the compiler cannot make itself, such as the levels.

Each entry is a function ``rows(add)``. It returns the rows of its list, and calls ``add`` with the
diagnostics that it finds.
"""


@click.command(
    epilog="""\b
Examples:
  tltlc list predicates                   the standard library
  tltlc list predicates --library mine    and your folder
  tltlc list targets --json
  tltlc list levels                       the levels of the stealth game and their variants
  tltlc list games                        these, and the scenes of the game files in this folder
  tltlc list codes
"""
)
@click.argument("what", type=click.Choice(("predicates", "targets", "games", "levels", "codes")))
@click.option(
    "--library",
    "-L",
    "libraries",
    metavar="DIR",
    type=click.Path(path_type=Path),
    multiple=True,
    help="List the predicates of this folder, too (repeatable).",
)
@click.option("--json", "as_json", is_flag=True, help="Print a JSON list.")
def command(what: str, libraries: tuple[Path, ...], as_json: bool) -> int:
    """List all predicates, targets, games, levels or error codes, each with a short description."""
    from tltlc.interfaces.cli.report import Report

    with Report() as report:
        rows = list(_predicates(libraries, report.add) if what == "predicates" else _rows(what, report.add))
        if as_json:
            print(json.dumps(rows, indent=2, ensure_ascii=False))
        else:
            show(rows)
    return report.status


def show(rows: list[ListRow]) -> None:
    """Print a table if standard output is a terminal, and tab-separated columns otherwise."""
    if sys.stdout.isatty():
        _table(rows)
    else:
        _lines(rows)


def _predicates(libraries: tuple[Path, ...], add: Callable[..., None]) -> Iterator[ListRow]:
    """Yield a row for each predicate in ``libraries``, the project's libraries and the standard library.

    A row has the predicate's ``name``, ``library``, ``signature`` as declared, and ``doc``. For files
    that cannot be read or parsed, call ``add`` with the errors.
    """
    from tltlc.grammar.parser import parse
    from tltlc.grammar.tree import PredicateDecl
    from tltlc.interfaces.cli.settings import check_libraries
    from tltlc.io.files import may_be_file, read_source
    from tltlc.io.project import project_for
    from tltlc.resolve.imports import standard_library

    check_libraries(libraries)
    for folder in (*libraries, *project_for("-").libraries, standard_library()):
        for path in sorted(filter(may_be_file, folder.glob("*.tltl"))):
            try:
                source = read_source(path)
            except TltlError as error:
                add(error.diagnostics)
                continue
            module, diagnostics = parse(source)
            add(diagnostics)
            for declaration in module.declarations:
                if isinstance(declaration, PredicateDecl):
                    signature = declaration.name
                    if declaration.parameters:
                        end = max(parameter.span.end for parameter in declaration.parameters)
                        signature = " ".join(source.text[declaration.name_span.start : end].split()) + ")"
                    yield {
                        "name": declaration.name,
                        "library": path.stem,
                        "signature": signature,
                        "doc": " ".join(declaration.doc.split()),
                    }


def _targets() -> Iterator[ListRow]:
    from tltlc import backends

    for name in backends.targets():
        target = backends.target(name)
        yield {"name": name, "files": ", ".join(target.file_names("NAME")), "doc": target.title}


def _codes() -> Iterator[ListRow]:
    from tltlc.diagnostics import code_pages

    for code in code_pages.codes():
        yield {"name": code, "doc": code_pages.title(code)}


_OWN_LISTS: dict[str, Callable[[], Iterator[ListRow]]] = {"targets": _targets, "codes": _codes}


def _rows(what: str, add: Callable[..., None]) -> Iterator[ListRow]:
    """Return the rows of the list called ``what``, such as ``targets`` or ``levels``.

    Raise TLT0730 if the runtime makes this list and is not installed. ``add`` is called with the
    diagnostics of the list.
    """
    from tltlc.interfaces.cli import plugins
    from tltlc.interfaces.cli.exits import missing_component

    if what in _OWN_LISTS:
        return _OWN_LISTS[what]()
    command = f"`tltlc list {what}`"
    for plugin in plugins.find(LISTS):
        if plugin.name == what:
            rows: Callable[[Callable[..., None]], Iterator[ListRow]] = plugins.load(plugin, command)
            return rows(add)
    raise missing_component(command, "tltl_runtime", "tltlc[game]")


def _lines(rows: list[ListRow]) -> None:
    """Print each row as a line of tab-separated values.

    If a row has a signature, leave out its name, because the signature contains the name.
    """
    for row in rows:
        print("\t".join(value for key, value in row.items() if not (key == "name" and "signature" in row)))


def _table(rows: list[ListRow]) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD)
    keys = [key for key in rows[0] if not (key == "name" and "signature" in rows[0])] if rows else []
    for key in keys:
        table.add_column(key, overflow="fold", style="bold" if key in ("name", "signature") else "")
    for row in rows:
        table.add_row(*(Text(row[key]) for key in keys))
    Console().print(table)
