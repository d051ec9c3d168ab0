"""The options and the writing that all commands share which make files of automata."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tltlc.interfaces.cli.paths import OutputPath

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.backends import Files
    from tltlc.interfaces.cli.report import Report
    from tltlc.io.project import Project

output_option = click.option(
    "--output", "-o", "folder", metavar="DIR", type=OutputPath("folder"), default=".", help="Write here."
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
    """The targets that are asked for; raises TltlError, TLT0710, for one that there is not."""
    from tltlc import backends

    asked = [name.strip() for names in lists for name in names.split(",")]
    for target in asked:
        backends.target(target)
    return asked


def files_of(automata: Iterable[Fspa], asked: Sequence[str], project: Project, report: Report) -> Files:
    """The files of what is asked for of each automaton, else of the project's targets, else of the usual ones.

    Raises click.UsageError where two targets write the same file.
    """
    from tltlc import backends

    targets = dict.fromkeys(asked or project.targets or backends.DEFAULT_TARGETS)
    options = backends.Options(notation=project.notation, report=lambda diagnostic: report.add((diagnostic,)))
    files: Files = {}
    for fspa in automata:
        writers: dict[str, str] = {}
        for target in targets:
            for name, content in backends.emit(target, fspa, options).items():
                other = writers.setdefault(name, target)
                if other != target:
                    raise click.UsageError(
                        f"`{other}` and `{target}` both write `{name}`: ask for one, with -t, and for the other with "
                        "an -o of its own"
                    )
                files[name] = content
    return files


def write_and_tell(folder: Path, files: Files, report: Report, advice: str = "name another folder with -o") -> None:
    """Write all of the files or none, and tell of each that has changed.

    Raises TltlError: TLT0005 or TLT0700, with ``advice``, as :func:`tltlc.io.writing.write_files` does.
    """
    from tltlc.io.writing import write_files

    written = write_files(folder, files, advice)
    for path in written:
        report.say(f"wrote {path}")
    unchanged = len(files) - len(written)
    if unchanged:
        report.say(f"{unchanged} files have not changed" if unchanged > 1 else "1 file has not changed")
