"""``tltlc test``: the test blocks of files, and of all files of folders."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tltlc.cli.settings import Settings, source_options
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.grammar.words import DECLARATIONS

if TYPE_CHECKING:
    from tltlc.monitor.tests import TestResult


@click.command(
    epilog="""\b
Examples:
  tltlc test cover_and_hide.tltl
  tltlc test levels.tltl:level_1     only the tests of that spec
  tltlc test levels                  every .tltl file in the folder, and below
"""
)
@click.argument("paths", metavar="FILE_OR_FOLDER...", nargs=-1, required=True)
@source_options
def command(paths: tuple[str, ...], settings: Settings, format: str) -> int:  # noqa: A002
    """Run test blocks: a line for each on standard output, and what went wrong on standard error.

    The exit status is 1 where a test fails or a file has errors.
    """
    from tltlc.cli.report import Report

    passed = failed = unread = 0
    with Report(format, results=True) as report:
        for argument in paths:
            before = passed + failed + unread
            for path in _files(argument):
                try:
                    results = _run(path, settings, report.add)
                except TltlError as error:
                    report.add(error.diagnostics)
                    unread += 1
                    continue
                for result in results:
                    verdict = "passed" if result.passed else "FAILED"
                    print(f"{verdict}  {_place(result)}  {result.test.title}", flush=True)
                    passed, failed = passed + result.passed, failed + (not result.passed)
                    report.add([result.failure] if result.failure else [])
            if passed + failed + unread == before:
                report.say(f"{argument}: no test block; the form is {DECLARATIONS['test']}")
        print(f"{passed} passed, {failed} failed{_unread(unread)}")
    return report.status


def _files(argument: str) -> list[str]:
    """The argument itself, or the sources in a folder; error TLT0722 where there are none."""
    folder = Path(argument)
    if not os.path.isdir(folder):  # noqa: PTH112 (pathlib raises where a name is too long)
        return [argument]
    inside = [file for file in sorted(folder.rglob("*.tltl")) if not _is_hidden(file.relative_to(folder))]
    if not inside:
        raise TltlError([Diagnostic("TLT0722", f"there is no .tltl file in `{argument}`", help="name another folder")])
    return [str(file) for file in inside]


def _is_hidden(path: Path) -> bool:
    return any(part.startswith(".") for part in path.parts)


def _run(path: str, settings: Settings, add: Callable[[Iterable[Diagnostic]], None]) -> tuple[TestResult, ...]:
    from tltlc.cli.inputs import open_input
    from tltlc.monitor.tests import run_tests

    opened = open_input(path, settings)
    add(opened.diagnostics)
    if opened.program is None:
        title = f"`{opened.name}` is an artefact, and artefacts hold no test blocks"
        raise TltlError([Diagnostic("TLT0722", title, help="name the .tltl file that it was compiled from")])
    return run_tests(opened.program, opened.automata)


def _unread(files: int) -> str:
    """How many files have errors, so that none of their tests ran."""
    return f", {files} {'file' if files == 1 else 'files'} with errors" if files else ""


def _place(result: TestResult) -> str:
    source, span = result.test.source, result.test.span
    return f"{source.name}:{source.position(span.start)[0]}"
