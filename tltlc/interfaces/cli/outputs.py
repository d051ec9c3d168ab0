"""Options and functions for all commands that generate files from automata."""

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
    from tltlc.pipeline import Session

output_option = click.option(
    "--output", "-o", "folder", metavar="DIR", type=OutputPath("folder"), default=".", help="The folder for the files."
)

target_option = click.option(
    "--target",
    "-t",
    "target_lists",
    metavar="TARGETS",
    multiple=True,
    help="What to write, separated by commas; see `tltlc list targets` (default: the targets in tltl.toml, or else "
    "json,dot,python).",
)


def targets_of(lists: Iterable[str]) -> list[str]:
    """Return the targets (output formats) named in comma-separated lists: ``["json,dot"] -> ["json", "dot"]``.

    Raise TltlError, TLT0710, for an unknown name.
    """
    from tltlc import backends

    targets = [name.strip() for names in lists for name in names.split(",")]
    for target in targets:
        backends.target(target)
    return targets


def files_of(
    automata: Iterable[Fspa],
    requested: Sequence[str],
    project: Project,
    report: Report,
    session: Session | None = None,
) -> Files:
    """Return the generated files of all automata, by name, for the targets (output formats) ``requested``.

    If no targets are requested, use those of the project file, or else the default targets. Notes
    about what a target leaves out are added to ``report``. ``session`` is the compiler's session for the
    source text of the automata, if they have one. Raises click.UsageError if two targets
    or two automata write the same file.
    """
    from tltlc import backends

    targets = dict.fromkeys(requested or project.targets or backends.DEFAULT_TARGETS)
    options = backends.Options(
        notation=project.notation,
        report=lambda diagnostic: report.add((diagnostic,)),
        without_timers=session.without_timers if session else None,
    )
    files: Files = {}
    specs: dict[str, str] = {}
    for fspa in automata:
        writers: dict[str, str] = {}
        for target in targets:
            for name, content in backends.emit(target, fspa, options).items():
                earlier = writers.setdefault(name, target)
                if earlier != target:
                    raise click.UsageError(
                        f"`{earlier}` and `{target}` both write `{name}`: choose one with -t, and write the other to "
                        "another folder with -o"
                    )
                if name in files and specs[name] != fspa.name:
                    raise click.UsageError(
                        f"the specs `{specs[name]}` and `{fspa.name}` both make `{name}`: rename one of them"
                    )
                files[name], specs[name] = content, fspa.name
    return files


def write_and_report(folder: Path, files: Files, report: Report, advice: str = "name another folder with -o") -> None:
    """Write all of the files or none into ``folder``, and report each file that changed.

    Raises TltlError: TLT0005 or TLT0700, like :func:`tltlc.io.writing.write_files`. ``advice`` is the
    help of the error.
    """
    from tltlc.io.writing import write_files

    changed_paths = write_files(folder, files, advice)
    for path in changed_paths:
        report.say(f"wrote {path}")
    unchanged = len(files) - len(changed_paths)
    if unchanged:
        report.say(f"{unchanged} files have not changed" if unchanged > 1 else "1 file has not changed")
