"""``tltlc watch``: what is wrong in source files, what is likely to be, and which tests fail, after each change."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Container
from typing import TYPE_CHECKING

import click

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.cli.settings import Settings, check_libraries, compile_options, compile_settings

if TYPE_CHECKING:
    from tltlc.diagnostics.diagnostic import Diagnostic
    from tltlc.monitor.tests import TestResult
    from tltlc.tools.lint.rule import Finding

_CLEAR = "\x1b[2J\x1b[3J\x1b[H"
"""Empties the screen of a terminal, with what has left it above."""


@click.command(
    epilog="""\b
Examples:
  tltlc watch                    the files of this folder, and below
  tltlc watch levels lib.tltl
"""
)
@click.argument("paths", metavar="[FILE_OR_FOLDER]...", nargs=-1)
@compile_options
def command(paths: tuple[str, ...], settings: Settings) -> int:
    """Check and lint source files and run their tests, again whenever one of them changes, until Ctrl-C.

    Changes of what they import count, and files that are new in a folder.  `tltlc compile --watch` writes files, too.
    """
    from tltlc.interfaces.cli.folders import in_folders
    from tltlc.interfaces.cli.watching import repeat
    from tltlc.io.spec_file import STDIN

    arguments = paths or (".",)
    if STDIN in arguments:
        raise click.UsageError("`tltlc watch` takes files and folders: standard input does not change")
    check_libraries(settings.libraries)

    def look(changed: tuple[str, ...]) -> None:
        if sys.stderr.isatty() and os.environ.get("TERM") != "dumb":
            sys.stderr.write(_CLEAR)
        elif changed:
            print(file=sys.stderr)
        said = f" changed: {', '.join(changed)}" if changed else ""
        print(f"{time.strftime('%H:%M:%S')}{said}", file=sys.stderr, flush=True)
        _look(arguments, settings)
        print("waiting for changes, until Ctrl-C", file=sys.stderr, flush=True)

    repeat(look, lambda: in_folders(arguments))


def _look(arguments: tuple[str, ...], settings: Settings) -> None:
    """Tell everything there is to be told of the files, and what it comes to."""
    from tltlc.interfaces.cli.folders import every_source
    from tltlc.interfaces.cli.report import Report, counted, tally
    from tltlc.io.files import note
    from tltlc.tools.lint.importers import used_elsewhere, words
    from tltlc.tools.lint.neighbours import neighbours

    report = Report()
    every = every_source(arguments, report)
    for path in (*every, *arguments):
        # Under this name a change is told of, and not under that of a neighbour.
        note(path)
    others = [words(str(path), text) for path, text in neighbours(every).items()]
    passed = 0
    failures: list[Diagnostic] = []
    for path in every:
        try:
            found, results = _file(path, used_elsewhere(path, others), settings)
        except TltlError as error:
            report.add(error.diagnostics)
            continue
        failed = [result.failure for result in results if result.failure]
        report.add([*(each.diagnostic for each in found), *failed])
        passed, failures = passed + len(results) - len(failed), failures + failed
    told = [tally(each for each in report.found if each not in failures)]
    told += [f"{counted(passed, 'test')} passed"] if passed else []
    told += [f"{counted(len(failures), 'test')} FAILED"] if failures else []
    report.say(f"{counted(len(every), 'file')}: {', '.join(told)}")


def _file(
    path: str, elsewhere: Container[str], settings: Settings
) -> tuple[tuple[Finding, ...], tuple[TestResult, ...]]:
    """What there is to be said of a file, which is compiled once, and what became of its tests."""
    from tltlc.core.record import replace
    from tltlc.interfaces.cli.inputs import check_text
    from tltlc.io.files import read_source
    from tltlc.io.project import project_for
    from tltlc.monitor.tests import run_tests
    from tltlc.tools.lint.run import findings, view_of

    project = project_for(path)
    source = read_source(path)
    check_text(source)
    with project.levelling():
        view = view_of(source, compile_settings(settings, project))
    found = findings(replace(view, elsewhere=elsewhere), project.lint)
    return found, run_tests(view.program, (each.fspa for each in view.specs))
