"""The options and the writing that all commands share which make files of automata."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.cli.report import Report
    from tltlc.project import Project

output_option = click.option(
    "--output", "-o", "folder", metavar="DIR", type=click.Path(path_type=Path), default=".", help="Write here."
)

target_option = click.option(
    "--target",
    "-t",
    "target_lists",
    metavar="TARGETS",
    multiple=True,
    help="What to write, by commas: `tltlc list targets` (default: json,dot,python, or those of tltl.toml).",
)


def targets_of(lists: Iterable[str]) -> list[str]:
    """The targets that are asked for; raises TltlError, TLT0700, for one that there is not."""
    from tltlc import backends

    asked = [name.strip() for names in lists for name in names.split(",")]
    for target in asked:
        backends.target(target)
    return asked


def write_automata(
    automata: Iterable[Fspa],
    asked: Sequence[str],
    folder: Path,
    project: Project,
    report: Report,
    read: Collection[str] = (),
) -> tuple[Path, ...]:
    """Write what is asked for of each automaton, all of it or nothing, and tell of each file; their paths.

    Raises click.UsageError where one of the files that were ``read`` would be written over, or one target's file by
    another's.
    """
    from tltlc import backends
    from tltlc.files import is_same
    from tltlc.writing import write_files

    targets = dict.fromkeys(asked or project.targets or backends.DEFAULT_TARGETS)
    options = backends.Options(notation=project.notation, report=lambda diagnostic: report.add((diagnostic,)))
    files: dict[str, str | bytes] = {}
    for fspa in automata:
        writers: dict[str, str] = {}
        for target in targets:
            for name, content in backends.emit(target, fspa, options).items():
                other = writers.setdefault(name, target)
                if other != target:
                    raise click.UsageError(f"`{other}` and `{target}` both write `{name}`: give each its own -o")
                files[name] = content
    for name in files:
        for input_ in read:
            if is_same(folder / name, input_):
                raise click.UsageError(f"`{input_}` would be written over: give another folder, with -o, or a --name")
    written = write_files(folder, files)
    for path in written:
        report.say(f"wrote {path}")
    if len(written) < len(files):
        report.say(_unchanged(len(files) - len(written)))
    return tuple(folder / name for name in files)


def _unchanged(count: int) -> str:
    return f"{count} files have not changed" if count > 1 else "1 file has not changed"
