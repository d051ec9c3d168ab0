"""``tltlc diff``: report how the specs of two files differ."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING

import click

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.settings import CompileSettings, compile_options, search_steps
from tltlc.io.spec_file import STDIN, split

if TYPE_CHECKING:
    from tltlc.interfaces.cli.inputs import Input
    from tltlc.tools.diff.assumed_exclusive import DeclaredGroups
    from tltlc.tools.diff.pairs import FileDiff


@click.command(
    epilog="""\b
Examples:
  tltlc diff vault.tltl vault_new.tltl             specs with the same name
  tltlc diff vault.tltl:heist vault.tltl:heist_2   two specs of a file
  tltlc diff build/heist.fspa.json vault.tltl      what changed since the artefact
  tltlc diff main:vault.tltl vault.tltl            what changed since a Git revision
  tltlc diff old.tltl new.tltl --format json
"""
)
@click.argument("a", metavar="A[:SPEC]")
@click.argument("b", metavar="B[:SPEC]")
@click.option(
    "--by-name", is_flag=True, help="Treat atoms with the same name as equal, even if their expressions differ."
)
@compile_options
@click.option(
    "--format", type=click.Choice(("text", "json")), default="text", help="The format of the output (default: text)."
)
def command(a: str, b: str, by_name: bool, settings: CompileSettings, format: str) -> int:  # noqa: A002
    """Say how B differs from A (files, FILE:NAME, artefacts, REV:FILE of a Git revision, or - for standard input).

    The output says whether B is equivalent, stricter or looser. Shortest traces that only one of them accepts show
    why, in words and as test blocks. Then the output lists other differences: limit, judge, level, meanings of atoms,
    signals, params, exclusive atoms. The exit status is 0 if nothing differs, and 1 otherwise.
    """
    from tltlc.interfaces.cli.report import Report
    from tltlc.tools.diff.pairs import diff_files

    difference: FileDiff | None = None
    with Report(results=True) as report:
        ours, theirs, one_each = _open_sides(a, b, settings)
        difference = diff_files(
            (_side_name(a, ours), ours.automata),
            (_side_name(b, theirs), theirs.automata),
            one_each=one_each,
            by_name=by_name,
            work=search_steps(settings),
            declared=_exclusive_declarations(ours, theirs),
        )
        if format == "json":
            from tltlc.tools.diff.diff_json import document

            print(json.dumps(document(difference), ensure_ascii=False, indent=2))
        else:
            from tltlc.tools.diff.text import text

            print(text(difference), end="")
    return report.status or (exits.CLEAN if difference and difference.is_same else exits.FINDINGS)


def _open_sides(a: str, b: str, settings: CompileSettings) -> tuple[Input, Input, bool]:
    """Compile the two arguments of ``tltlc diff``, and select the specs to compare.

    Return both inputs, and whether at least one argument names a spec. If so, each input has a
    single spec, and these two are compared even if their names differ. Raises click.UsageError if
    both are standard input, and TltlError if a file has errors or no single spec can be selected.
    """
    (path_a, name_a), (path_b, name_b) = split(a), split(b)
    if path_a == path_b == STDIN:
        raise click.UsageError("A and B cannot both be standard input")
    ours, theirs = _open_side(a, settings), _open_side(b, settings)
    if name_a is None and name_b is None:
        return ours, theirs, False
    ours, theirs = _matching_spec(name_b, ours), _matching_spec(name_a, theirs)
    ours.only_automaton(), theirs.only_automaton()
    return ours, theirs, True


def _open_side(argument: str, settings: CompileSettings) -> Input:
    """Compile one argument: ``FILE``, or ``REV:FILE``, which is FILE at the Git revision REV.

    Raises the errors of :func:`~tltlc.interfaces.cli.inputs.open_input`. For ``REV:FILE``, also
    raises those of :func:`~tltlc.tools.diff.revisions.earlier_files`, and TLT0751 if the revision
    has no such file.
    """
    from tltlc.interfaces.cli.inputs import open_input

    path, name = split(argument)
    revision, file = _split_revision(path)
    if not revision:
        return open_input(argument, settings)
    from tltlc.tools.diff.revisions import earlier_files

    with earlier_files(revision, [file]) as old:
        before = old.old_path(file)
        if before is None:
            help_ = "name a file of that revision, by its path from the current folder"
            raise TltlError([Diagnostic("TLT0751", f"there is no file `{file}` in `{revision}`", help=help_)])
        old_settings = replace(settings, libraries=old.old_libraries(settings.libraries))
        try:
            side = open_input(before if name is None else f"{before}:{name}", old_settings)
        except TltlError as error:
            raise TltlError(old.with_display_names(error.diagnostics)) from None
        return replace(side, name=path)


def _split_revision(path: str) -> tuple[str, str]:
    """Split ``REV:FILE`` into revision and file: ``main:vault.tltl -> ("main", "vault.tltl")``.

    If ``path`` names no revision, return an empty text and ``path``.
    """
    from tltlc.tools.diff.revisions import SOURCE_ENDINGS

    revision, _, file = path.partition(":")
    is_drive = os.name == "nt" and len(revision) == 1
    if not file.endswith(SOURCE_ENDINGS) or is_drive or os.path.exists(path):  # noqa: PTH110 (pathlib raises where a name is too long)
        return "", path
    return revision, file


def _exclusive_declarations(a: Input, b: Input) -> DeclaredGroups:
    """Return the ``exclusive`` declarations of both inputs; for an artefact, which does not store them, None."""
    return (a.program.exclusive if a.program else None, b.program.exclusive if b.program else None)


def _matching_spec(name: str | None, side: Input) -> Input:
    """Return an input of ``tltlc diff`` with only its spec called ``name``.

    ``name`` is the spec that the other argument names. Return ``side`` unchanged if ``name`` is None,
    or if ``side`` has no spec of that name.
    """
    matches = tuple(fspa for fspa in side.automata if fspa.name == name)
    return replace(side, automata=matches or side.automata)


def _side_name(argument: str, side: Input) -> str:
    """Return the name of an input as the report shows it: ``FILE`` or ``FILE:SPEC``."""
    name = split(argument)[1]
    return side.name if name is None else f"{side.name}:{name}"
