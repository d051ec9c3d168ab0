"""``tltlc compile``: generate the files of all specs, then write them all."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.outputs import files_of, output_option, target_option, targets_of, write_and_report
from tltlc.interfaces.cli.settings import CompileSettings, source_options

if TYPE_CHECKING:
    from tltlc.backends import Files
    from tltlc.interfaces.cli.inputs import Input
    from tltlc.interfaces.cli.report import Report


@click.command(
    epilog="""\b
Examples:
  tltlc compile leave.tltl                           three files in the current folder
  tltlc compile leave.tltl -o build -t json,svg
  tltlc compile levels.tltl --spec level_1 --spec level_2
  tltlc compile build/level_1.fspa.json -t python    from an artefact
  tltlc compile levels -o Assets/Specs -t csharp --watch    all .tltl files in the folder and its subfolders
"""
)
@click.argument("specs", metavar="SPEC_OR_FOLDER...", nargs=-1, required=True)
@output_option
@target_option
@click.option(
    "--spec", "names", metavar="NAME", multiple=True, help="Compile only the spec with this name (repeatable)."
)
@click.option("--watch", is_flag=True, help="Compile again whenever one of the files changes, until you press Ctrl-C.")
@source_options
def command(
    specs: tuple[str, ...],
    folder: Path,
    target_lists: tuple[str, ...],
    names: tuple[str, ...],
    watch: bool,
    settings: CompileSettings,
    format: str,  # noqa: A002
) -> int:
    """Compile the specs of each SPEC (a file, FILE:NAME, an artefact, or - for standard input).

    For each spec NAME, the command writes NAME.fspa.json, NAME.dot and NAME_monitor.py, or the targets of -t. If there
    is an error, it writes nothing. It does not touch files that would not change. In a folder (`.` is the current
    folder), all .tltl files are compiled, also those in subfolders.
    """
    from tltlc.interfaces.cli.folders import every_source, files_in_folders
    from tltlc.interfaces.cli.report import Report
    from tltlc.io.resources import resource_limits

    def compile_once(changed: tuple[str, ...] = ()) -> int:
        with resource_limits(), Report(format) as report:
            if changed:
                report.say(f"\n{time.strftime('%H:%M:%S')} changed: {', '.join(changed)}")
            targets = targets_of(target_lists)
            files: Files = {}
            sources: dict[str, str] = {}
            for spec_input in _valid_inputs(every_source(specs, report), settings, names, report):
                if not spec_input.automata and spec_input.name not in files_in_folders(specs):
                    report.say(f"{spec_input.name}: it contains no spec")
                generated = files_of(spec_input.automata, targets, spec_input.project, report, spec_input.session)
                _check_distinct(generated, spec_input.name, sources, is_waiting=bool(changed))
                files |= generated
            if report.status == exits.CLEAN:
                write_and_report(folder, files, report)
        return report.status

    def compile_and_wait(changed: tuple[str, ...]) -> None:
        try:
            status = compile_once(changed)
        except click.UsageError as error:
            # A new edit of `tltl.toml` may have caused the clash of two targets, so keep waiting for changes.
            if not changed:
                raise
            status = exits.report(error)
        # No change of a file would fix the command line.
        if status in (exits.USAGE, exits.UNREADABLE) and not changed:
            raise exits.StopQuietlyError(status)
        if format == "text":
            print("waiting for changes (press Ctrl-C to stop)", file=sys.stderr)

    if watch:
        from tltlc.interfaces.cli.repeated_runs import repeat
        from tltlc.io.spec_file import STDIN, split

        if any(split(spec)[0] == STDIN for spec in specs):
            raise click.UsageError("--watch takes files: standard input does not change")
        repeat(compile_and_wait, lambda: files_in_folders(specs))
    return compile_once()


def _valid_inputs(
    specs: list[str], settings: CompileSettings, names: tuple[str, ...], report: Report
) -> Iterator[Input]:
    """Compile each of ``specs``, the arguments of the command line, and yield those without errors.

    All diagnostics are added to ``report``. If there are ``names``, only specs with these names are
    compiled.

    Raises click.UsageError: an argument is a project file.
    """
    from tltlc.diagnostics.diagnostic import TltlError
    from tltlc.interfaces.cli.inputs import open_input

    for spec in specs:
        try:
            spec_input = open_input(spec, settings, names)
        except TltlError as error:
            report.add(error.diagnostics)
            continue
        report.add(spec_input.diagnostics)
        yield spec_input


def _check_distinct(files: Files, source: str, sources: dict[str, str], *, is_waiting: bool) -> None:
    """Raise TLT0700 if one of ``files`` has the name of an output file of another source file.

    ``files`` are the output files made from ``source``. ``sources`` maps the name of each output
    file so far to its source; this function adds the names of ``files``. ``is_waiting`` says
    whether the command runs again after a change of a file. Then the help of the error suggests only
    an edit, and not another command line.
    """
    from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

    for name in files:
        if name in sources:
            alternative = "" if is_waiting else ", or compile each file into a folder of its own, with -o"
            title = f"`{sources[name]}` and `{source}` both make `{name}`"
            raise TltlError([Diagnostic("TLT0700", title, help=f"rename one of the specs{alternative}")])
        sources[name] = source
