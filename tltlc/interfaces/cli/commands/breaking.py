"""``tltlc breaking``: report changes of specs and libraries that break a game or a baseline.

The old files come from a Git revision or from a folder.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli.settings import CompileSettings, search_steps, source_options
from tltlc.io.spec_file import STDIN, split

if TYPE_CHECKING:
    from tltlc.tools.diff.breaking import FileChange, Version
    from tltlc.tools.diff.revisions import EarlierTree

_SERVICE_FORMATS: Final = ("github", "sarif")
"""Formats for services that know only the current files, so that labels must point into these."""


@click.command(
    epilog="""\b
Examples:
  tltlc breaking specs --against main              every spec and library of a folder
  tltlc breaking vault.tltl --against v1.2 --format github
  tltlc breaking build/*.fspa.json --against ../released
"""
)
@click.argument("paths", metavar="FILE_OR_FOLDER...", nargs=-1, required=True)
@click.option(
    "--against",
    metavar="REV|DIR",
    required=True,
    help="The folder with the old files. If there is no such folder, a Git revision.",
)
@source_options
def command(paths: tuple[str, ...], against: str, settings: CompileSettings, format: str) -> int:  # noqa: A002
    """Report changes of specs, artefacts and libraries that break a game or a recorded baseline.

    Errors are changes that break it: a spec is gone or stricter, the game must supply a new signal, a predicate has
    another meaning. Warnings are changes of numbers or behaviour after which everything still works. Notes need no
    action. The exit status is 1 if there is an error. The old files use the old versions of the files that they import.
    """
    from tltlc.interfaces.cli.report import Report
    from tltlc.tools.diff.breaking import version_changes
    from tltlc.tools.diff.renamed_specs import follow_moves
    from tltlc.tools.diff.revisions import earlier_files

    for path in paths:
        if path == STDIN or split(path)[1] is not None:
            raise click.UsageError(f"`{path}` is not a path: name files and folders")
    diagnostics: list[Diagnostic] = []
    with Report(format) as report, earlier_files(against, paths) as old:

        def for_report(diagnostics: Iterable[Diagnostic], path: str) -> tuple[Diagnostic, ...]:
            at_new_places = (
                old.with_current_labels(diagnostics, path, old.old_path(path))
                if format in _SERVICE_FORMATS
                else diagnostics
            )
            return old.with_display_names(at_new_places)

        changes: list[FileChange] = []
        for path in dict.fromkeys(path for argument in paths for path in _files(argument, old)):
            try:
                changes.append(_change(path, old, settings))
            except TltlError as error:
                report.add(for_report(error.diagnostics, path))
        for change in follow_moves(changes, search_steps(settings)):
            try:
                file_diagnostics = for_report(version_changes(change, search_steps(settings)), change.path)
            except TltlError as error:
                report.add(error.diagnostics)
                continue
            report.add(file_diagnostics)
            diagnostics += file_diagnostics
            if not file_diagnostics and os.path.exists(change.path):  # noqa: PTH110 (as below)
                report.say(f"{change.path}: no changes that others notice")
        counts = [
            sum(diagnostic.severity == severity for diagnostic in diagnostics)
            for severity in ("error", "warning", "note")
        ]
        report.say("{} breaking, {} changed, {} compatible".format(*counts))
    return report.status


def _files(argument: str, old: EarlierTree) -> list[str]:
    """Return the paths of the files to compare: the argument itself, or all spec files in it if it is a folder.

    These are the specs, libraries and artefacts in the new or the old version of the folder. Raise
    TLT0722 if neither version contains any.
    """
    from tltlc.io.files import files_below
    from tltlc.tools.diff.revisions import SOURCE_ENDINGS

    folders = [folder for folder in (argument, old.old_path(argument)) if folder is not None and os.path.isdir(folder)]  # noqa: PTH112
    if not folders:
        return [argument]
    # The folder with the old files may lie inside the new folder. Skip the old files.
    candidates = {path for folder in folders for path in files_below(Path(folder), SOURCE_ENDINGS)}
    spec_files = [path for path in sorted(candidates) if not old.contains(Path(argument, path))]
    if not spec_files:
        title = f"there is no spec, library or artefact in `{argument}`"
        raise TltlError([Diagnostic("TLT0722", title, help="name another folder")])
    return [str(Path(argument, path)) for path in spec_files]


def _change(path: str, old: EarlierTree, settings: CompileSettings) -> FileChange:
    """Compile the old and the new version of a file; raise TltlError if either has errors.

    A version that does not exist counts as empty.
    """
    from tltlc.tools.diff.breaking import FileChange, Version

    before = old.old_path(path)
    is_there = os.path.exists(path)  # noqa: PTH110 (pathlib raises where a name is too long)
    new = _version(path, settings) if is_there or before is None else Version()
    if before is None:
        return FileChange(path, Version(), new)
    return FileChange(path, _version(before, replace(settings, libraries=old.old_libraries(settings.libraries))), new)


def _version(path: str, settings: CompileSettings) -> Version:
    """Compile a spec, library or artefact, and return what ``tltlc breaking`` compares of it."""
    from tltlc.interfaces.cli.inputs import open_input
    from tltlc.tools.diff.versions import version_of_artefact, version_of_library, version_of_specs

    spec_input = open_input(path, settings)
    if spec_input.session is None:
        return version_of_artefact(path, spec_input.automata)
    if spec_input.session.program.specs:
        return version_of_specs(spec_input.session.program, spec_input.automata)
    return version_of_library(spec_input.session)
