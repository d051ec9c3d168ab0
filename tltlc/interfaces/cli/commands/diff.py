"""``tltlc diff``: how the specs of two files differ."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING

import click

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.settings import Settings, compile_options, work_of
from tltlc.io.spec_file import STDIN, split

if TYPE_CHECKING:
    from tltlc.interfaces.cli.inputs import Input
    from tltlc.tools.diff.assumed_exclusive import Declared
    from tltlc.tools.diff.pairs import FileDiff


@click.command(
    epilog="""\b
Examples:
  tltlc diff vault.tltl vault_new.tltl             specs of one name, side by side
  tltlc diff vault.tltl:heist vault.tltl:heist_2   two specs of a file
  tltlc diff build/heist.fspa.json vault.tltl      what the artefact does not know yet
  tltlc diff main:vault.tltl vault.tltl            since a revision of git
  tltlc diff old.tltl new.tltl --format json
"""
)
@click.argument("a", metavar="A[:SPEC]")
@click.argument("b", metavar="B[:SPEC]")
@click.option("--by-name", is_flag=True, help="Take atoms of one name for one, whatever their expressions.")
@compile_options
@click.option(
    "--format", type=click.Choice(("text", "json")), default="text", help="How to say what differs (default: text)."
)
def command(a: str, b: str, by_name: bool, settings: Settings, format: str) -> int:  # noqa: A002
    """Say how B differs from A (files, FILE:NAME, artefacts, REV:FILE of a git revision, or - for standard input).

    Whether it is equivalent, stricter or looser, with a shortest trace for each direction, in words and as a test
    block; and what else differs: limit, judge, level, what atoms mean, signals, params, exclusive atoms.  The
    exit status is 0 where nothing differs, and 1 otherwise.
    """
    from tltlc.interfaces.cli.report import Report
    from tltlc.tools.diff.pairs import diff_files

    found: FileDiff | None = None
    with Report(results=True) as report:
        ours, theirs, one_each = _opened(a, b, settings)
        found = diff_files(
            (_shown(a, ours), ours.automata),
            (_shown(b, theirs), theirs.automata),
            one_each=one_each,
            by_name=by_name,
            work=work_of(settings),
            declared=_declared(ours, theirs),
        )
        if format == "json":
            from tltlc.tools.diff.diff_json import document

            print(json.dumps(document(found), ensure_ascii=False, indent=2))
        else:
            from tltlc.tools.diff.text import text

            print(text(found), end="")
    return report.status or (exits.CLEAN if found and found.is_same else exits.FINDINGS)


def _opened(a: str, b: str, settings: Settings) -> tuple[Input, Input, bool]:
    """Both files, with the specs to be compared, and whether that is one of each, whatever their names."""
    (path_a, name_a), (path_b, name_b) = split(a), split(b)
    if path_a == path_b == STDIN:
        raise click.UsageError("A and B cannot both be standard input")
    ours, theirs = _open(a, settings), _open(b, settings)
    if name_a is None and name_b is None:
        return ours, theirs, False
    ours, theirs = _like(name_b, ours), _like(name_a, theirs)
    ours.one(), theirs.one()
    return ours, theirs, True


def _open(argument: str, settings: Settings) -> Input:
    """A side as :func:`~tltlc.interfaces.cli.inputs.open_input` reads it; of ``REV:FILE`` the file as it was in that
    revision.

    Errors: those of :func:`~tltlc.tools.diff.revisions.earlier`, TLT0751 where the revision has no such file.
    """
    from tltlc.interfaces.cli.inputs import open_input

    path, name = split(argument)
    revision, file = _of_revision(path)
    if not revision:
        return open_input(argument, settings)
    from tltlc.tools.diff.revisions import earlier

    with earlier(revision, [file]) as old:
        before = old.at(file)
        if before is None:
            way_out = "name a file that was there, by its path from the current folder"
            raise TltlError([Diagnostic("TLT0751", f"there is no file `{file}` in `{revision}`", help=way_out)])
        of_old = replace(settings, libraries=old.libraries(settings.libraries))
        try:
            opened = open_input(before if name is None else f"{before}:{name}", of_old)
        except TltlError as error:
            raise TltlError(old.renamed(error.diagnostics)) from None
        return replace(opened, name=path)


def _of_revision(path: str) -> tuple[str, str]:
    """The revision and the file of ``REV:FILE``; no revision for the path of a file of now."""
    from tltlc.tools.diff.revisions import SOURCE_ENDINGS

    revision, _, file = path.partition(":")
    is_drive = os.name == "nt" and len(revision) == 1
    if not file.endswith(SOURCE_ENDINGS) or is_drive or os.path.exists(path):  # noqa: PTH110 (pathlib raises where a name is too long)
        return "", path
    return revision, file


def _declared(a: Input, b: Input) -> Declared:
    """The ``exclusive`` of both files; an artefact does not say what its file declared."""
    return (a.program.exclusive if a.program else None, b.program.exclusive if b.program else None)


def _like(name: str | None, opened: Input) -> Input:
    """The file with its spec of the name that the other side has, if there is one and it has several."""
    named = tuple(fspa for fspa in opened.automata if fspa.name == name)
    return replace(opened, automata=named or opened.automata)


def _shown(argument: str, opened: Input) -> str:
    """What the report calls a side."""
    name = split(argument)[1]
    return opened.name if name is None else f"{opened.name}:{name}"
