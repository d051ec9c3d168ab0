"""``tltlc diff``: how the specs of two files differ."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

from tltlc.cli import exits
from tltlc.cli.settings import Settings, compile_options, work_of
from tltlc.record import replace
from tltlc.spec_file import STDIN, split

if TYPE_CHECKING:
    from tltlc.cli.inputs import Input
    from tltlc.diff.pairs import FileDiff


@click.command(
    epilog="""\b
Examples:
  tltlc diff vault.tltl vault_new.tltl             specs of one name, side by side
  tltlc diff vault.tltl:heist vault.tltl:heist_2   two specs of a file
  tltlc diff build/heist.fspa.json vault.tltl      what the artefact does not know yet
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
    """Say how B differs from A (files, FILE:NAME, artefacts, or - for standard input).

    Whether it is equivalent, stricter or looser, with a shortest trace for each direction, in words and as a test
    block; and what else differs: limit, judge, level, what atoms mean, signals, params, exclusive atoms.  The
    exit status is 0 where nothing differs, and 1 otherwise.
    """
    from tltlc.cli.report import Report
    from tltlc.diff.pairs import diff_files

    found: FileDiff | None = None
    with Report(results=True) as report:
        ours, theirs, one_each = _opened(a, b, settings)
        found = diff_files(
            (_shown(a, ours), ours.automata),
            (_shown(b, theirs), theirs.automata),
            one_each=one_each,
            by_name=by_name,
            work=work_of(settings),
            exclusive=_exclusive_in_both(ours, theirs),
        )
        if format == "json":
            from tltlc.diff.document import document

            print(json.dumps(document(found), ensure_ascii=False, indent=2))
        else:
            from tltlc.diff.text import text

            print(text(found), end="")
    return report.status or (exits.CLEAN if found and found.is_same else exits.FINDINGS)


def _opened(a: str, b: str, settings: Settings) -> tuple[Input, Input, bool]:
    """Both files, with the specs to be compared, and whether that is one of each, whatever their names."""
    from tltlc.cli.inputs import open_input

    (path_a, name_a), (path_b, name_b) = split(a), split(b)
    if path_a == path_b == STDIN:
        raise click.UsageError("A and B cannot both be standard input")
    ours, theirs = open_input(a, settings), open_input(b, settings)
    if name_a is None and name_b is None:
        return ours, theirs, False
    ours, theirs = _like(name_b, ours), _like(name_a, theirs)
    ours.one(), theirs.one()
    return ours, theirs, True


def _exclusive_in_both(a: Input, b: Input) -> list[frozenset[str]]:
    """The groups of atoms that both sources declare to be exclusive, whatever their specs use of them."""
    if a.program is None or b.program is None:
        return []
    both = (frozenset(one).intersection(other) for one in a.program.exclusive for other in b.program.exclusive)
    return [group for group in both if len(group) > 1]


def _like(name: str | None, opened: Input) -> Input:
    """The file with its spec of the name that the other side has, if there is one and it has several."""
    named = tuple(fspa for fspa in opened.automata if fspa.name == name)
    return replace(opened, automata=named or opened.automata)


def _shown(argument: str, opened: Input) -> str:
    """What the report calls a side."""
    name = split(argument)[1]
    return opened.name if name is None else f"{opened.name}:{name}"
