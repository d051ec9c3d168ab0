"""``tltlc watch``: report errors, likely mistakes and failing tests, now and after each change of a file."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Container
from typing import TYPE_CHECKING

import click

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.cli.settings import CompileSettings, check_libraries, compile_options, compile_settings

if TYPE_CHECKING:
    from tltlc.diagnostics.diagnostic import Diagnostic
    from tltlc.monitor.spec_tests import TestResult
    from tltlc.tools.lint.rule import LintFinding

_CLEAR = "\x1b[2J\x1b[3J\x1b[H"
"""The text that clears the screen of a terminal and its scrollback."""


@click.command(
    epilog="""\b
Examples:
  tltlc watch                    all files in this folder and its subfolders
  tltlc watch levels lib.tltl
"""
)
@click.argument("paths", metavar="[FILE_OR_FOLDER]...", nargs=-1)
@compile_options
def command(paths: tuple[str, ...], settings: CompileSettings) -> int:
    """Check, lint and test source files again whenever one of them changes, until you press Ctrl-C.

    Changes in imported files count, and so do new files in a folder. `tltlc compile --watch` also writes files.
    """
    from tltlc.interfaces.cli.folders import files_in_folders
    from tltlc.interfaces.cli.repeated_runs import repeat
    from tltlc.io.spec_file import STDIN

    arguments = paths or (".",)
    if STDIN in arguments:
        raise click.UsageError("`tltlc watch` takes files and folders: standard input does not change")
    check_libraries(settings.libraries)

    def run_once(changed: tuple[str, ...]) -> None:
        if sys.stderr.isatty() and os.environ.get("TERM") != "dumb":
            sys.stderr.write(_CLEAR)
        elif changed:
            print(file=sys.stderr)
        change = f" changed: {', '.join(changed)}" if changed else ""
        print(f"{time.strftime('%H:%M:%S')}{change}", file=sys.stderr, flush=True)
        _check_files(arguments, settings)
        print("waiting for changes (press Ctrl-C to stop)", file=sys.stderr, flush=True)

    repeat(run_once, lambda: files_in_folders(arguments))


def _check_files(arguments: tuple[str, ...], settings: CompileSettings) -> None:
    """Check, lint and test the source files once; report the findings, the failed tests and a summary."""
    from tltlc.interfaces.cli.folders import every_source
    from tltlc.interfaces.cli.report import Report, count_text, tally
    from tltlc.io.access_log import log_lookup
    from tltlc.tools.lint.importers import importer_names, names_used_elsewhere
    from tltlc.tools.lint.joining import joined
    from tltlc.tools.lint.neighbours import neighbours

    report = Report()
    paths = every_source(arguments, report)
    for path in (*paths, *arguments):
        # If a file is logged under several paths, its changes are reported under the first one. So log the
        # paths that the user knows before the linter logs the files beside them.
        log_lookup(path)
    neighbour_words = [importer_names(str(path), text) for path, text in neighbours(paths).items()]
    passed = 0
    failures: list[Diagnostic] = []
    for path in paths:
        try:
            findings, results = _check_file(path, names_used_elsewhere(path, neighbour_words), settings)
        except TltlError as error:
            report.add(error.diagnostics)
            continue
        failed = [result.failure for result in results if result.failure]
        report.add([*joined(finding.diagnostic for finding in findings), *failed])
        passed, failures = passed + len(results) - len(failed), failures + failed
    summary = [tally(diagnostic for diagnostic in report.diagnostics if diagnostic not in failures)]
    summary += [f"{count_text(passed, 'test')} passed"] if passed else []
    summary += [f"{count_text(len(failures), 'test')} FAILED"] if failures else []
    report.say(f"{count_text(len(paths), 'file')}: {', '.join(summary)}")


def _check_file(
    path: str, elsewhere: Container[str], settings: CompileSettings
) -> tuple[tuple[LintFinding, ...], tuple[TestResult, ...]]:
    """Compile a file once, lint it, and run its tests; return the findings and the test results.

    ``elsewhere`` contains the names that other files may use, so their declarations are not
    reported as unused. Raises TltlError if the file has errors.
    """
    from tltlc.core.record import replace
    from tltlc.interfaces.cli.inputs import check_text
    from tltlc.io.files import read_source
    from tltlc.io.project import project_for
    from tltlc.monitor.spec_tests import run_tests
    from tltlc.tools.lint.run import findings, view_of

    project = project_for(path)
    source = read_source(path)
    check_text(source)
    with project.apply_lint_levels():
        view = view_of(source, compile_settings(settings, project))
    file_findings = findings(replace(view, used_elsewhere=elsewhere), project.lint)
    return file_findings, run_tests(view.program, (compiled.fspa for compiled in view.specs))
