"""What a run of a suite leaves beside its cases: the page, and the reports for programs."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path
from typing import Final

from tltl_runtime.regression.document import document
from tltl_runtime.regression.junit import junit
from tltl_runtime.regression.page.page import ReportedCase, SuiteReport, html_report
from tltl_runtime.regression.run import CASES, Done, case_folder
from tltl_runtime.regression.suite import Suite
from tltl_runtime.stealth.episodes.episode import Episode
from tltl_runtime.stealth.episodes.file import read_episode
from tltl_runtime.training.versions import versions
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.record import record
from tltlc.writing import write_file, write_files

PAGE: Final = "report.html"
"""The page in the folder of a run."""


@record
class Outcome:
    """What a run of a suite came to; ``left_out`` are the names of cases that no change concerns, ``missing`` of those
    that were not judged before the run was stopped.

    ``complete`` says whether all cases were judged, and trained for, that this was asked for.
    """

    suite: Suite
    cases: tuple[Done, ...]
    complete: bool
    left_out: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()


def json_text(outcome: Outcome) -> str:
    """The report for programs."""
    reports = [done.report for done in outcome.cases]
    found = document(outcome.suite, reports, complete=outcome.complete, left_out=outcome.left_out)
    return json.dumps(found, indent=2, ensure_ascii=False) + "\n"


def write_reports(outcome: Outcome, json_file: Path | None, junit_file: Path | None) -> None:
    """Write the reports that were asked for; raises TltlError, TLT0005."""
    if json_file is not None:
        write_file(json_file, json_text(outcome), "name another place with --json")
    if junit_file is not None:
        text = junit(outcome.suite, [done.report for done in outcome.cases], outcome.missing)
        write_file(junit_file, text, "name another place with --junit")


def write_page(outcome: Outcome, folder: Path, html_file: Path | None) -> Path:
    """Write the page into the folder of the run, and to where else it was asked for; its path.

    Raises:
        TltlError: TLT0005, it cannot be written; what drawing it raises.
    """
    suite = outcome.suite
    cases = tuple(_reported(done, suite, folder) for done in outcome.cases)
    contents = SuiteReport(
        suite=suite.path.stem,
        seed=suite.seed,
        error=suite.error,
        versions=versions(),
        cases=cases,
        complete=outcome.complete,
        missing=outcome.missing,
        left_out=outcome.left_out,
    )
    page = html_report(contents)
    write_files(folder, {PAGE: page}, "name another folder with --out")
    if html_file is None:
        return folder / PAGE
    write_file(html_file, page, "name another place with --html")
    return html_file


def _reported(done: Done, suite: Suite, folder: Path) -> ReportedCase:
    """A case with what the page draws of it."""
    if done.ready is None or done.reference is None:
        return ReportedCase(done.report)
    episodes = _episodes(done, case_folder(suite, done.report.name, folder / CASES))
    level, before = done.ready.level, done.reference.accounts
    return ReportedCase(done.report, level, done.ready.setup.fspa, episodes, before, _curve(done, folder))


def _curve(done: Done, folder: Path) -> bytes:
    """The picture of the case's training, empty where there is none, or it was removed since."""
    if done.report.retrained is None:
        return b""
    with suppress(OSError):
        return (folder / done.report.retrained.policy).with_name("curve.png").read_bytes()
    return b""


def _episodes(done: Done, folder: Path) -> dict[int, Episode]:
    """The recorded episodes by their index; one that was damaged since is left out."""
    found: dict[int, Episode] = {}
    for index, name in done.report.recordings:
        with suppress(TltlError):
            found[index] = read_episode(folder / name)
    return found
