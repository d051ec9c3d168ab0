"""``tltlc test``: run the ``test`` blocks of source files."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import click

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.grammar.keywords import DECLARATIONS
from tltlc.interfaces.cli.settings import CompileSettings, source_options

if TYPE_CHECKING:
    from tltlc.monitor.spec_tests import TestResult


@click.command(
    epilog="""\b
Examples:
  tltlc test                         all .tltl files in this folder and its subfolders
  tltlc test leave.tltl
  tltlc test levels.tltl:level_1     only the tests of that spec
  tltlc test levels                  another folder
"""
)
@click.argument("paths", metavar="[FILE_OR_FOLDER]...", nargs=-1)
@source_options
def command(paths: tuple[str, ...], settings: CompileSettings, format: str) -> int:  # noqa: A002
    """Run test blocks. Results go to standard output, one line per test; failures go to standard error.

    Without arguments, the command runs the tests of the current folder. The exit status is 1 if a test fails or a file
    has errors.
    """
    from tltlc.interfaces.cli.folders import every_source
    from tltlc.interfaces.cli.report import Report

    passed = failed = unreadable = 0
    with Report(format, results=True) as report:
        for argument in paths or (".",):
            before = passed + failed + unreadable
            paths_inside = every_source([argument], report)
            for path in paths_inside:
                try:
                    results = _run(path, settings, report.add)
                except TltlError as error:
                    report.add(error.diagnostics)
                    unreadable += 1
                    continue
                for result in results:
                    verdict = "passed" if result.passed else "FAILED"
                    print(f"{verdict}  {_place(result)}  {result.test.title}", flush=True)
                    passed, failed = passed + result.passed, failed + (not result.passed)
                    report.add([result.failure] if result.failure else [])
            if paths_inside and passed + failed + unreadable == before:
                report.say(f"{argument}: it contains no test block; the form is {DECLARATIONS['test']}")
        print(f"{passed} passed, {failed} failed{_unread_text(unreadable)}")
    return report.status


def _run(path: str, settings: CompileSettings, add: Callable[[Iterable[Diagnostic]], None]) -> tuple[TestResult, ...]:
    from tltlc.interfaces.cli.inputs import artefact_error, open_input
    from tltlc.monitor.spec_tests import run_tests

    spec_input = open_input(path, settings)
    add(spec_input.diagnostics)
    if spec_input.program is None:
        raise TltlError([artefact_error(spec_input.name)])
    return run_tests(spec_input.program, spec_input.automata)


def _unread_text(files: int) -> str:
    """Return the end of the summary, such as ``, 2 files with errors``; empty if there are no such files.

    The tests of these files did not run.
    """
    return f", {files} {'file' if files == 1 else 'files'} with errors" if files else ""


def _place(result: TestResult) -> str:
    source, span = result.test.source, result.test.span
    return f"{source.name}:{source.position(span.start)[0]}"
