"""The reports of a run of a suite: the HTML page, JSON and JUnit XML."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, Final, cast, get_args

from tltl_runtime.evaluation.versions import judging_versions, versions
from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.game import Game
from tltl_runtime.game.level import Level
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.episode_films import CaseFilms, episode_films
from tltl_runtime.regression.report.film_cache import films_hash, kept_films
from tltl_runtime.regression.report.junit import junit
from tltl_runtime.regression.report.page.contents import NotRun, ReportedCase, SuiteReport, maps_of
from tltl_runtime.regression.report.page.missing_map import with_plan
from tltl_runtime.regression.report.page.page import html_report
from tltl_runtime.regression.report.report_json import document
from tltl_runtime.regression.report.trace_curves import episode_curves, example_curves
from tltl_runtime.regression.suite.suite import SHIPPED, Suite
from tltl_runtime.regression.suite_run import CASES, FinishedCase, case_folder
from tltl_runtime.regression.verdict.baseline import Reference
from tltl_runtime.regression.verdict.level_texts import baseline_level
from tltl_runtime.regression.verdict.play import PreparedCase
from tltl_runtime.regression.verdict.verdict import CaseVerdict
from tltl_runtime.support.number_text import short_list
from tltl_runtime.support.record_json import to_json
from tltlc.api import TltlError, fileio, record, replace, traces

PAGE: Final = "report.html"
"""The name of the page in the folder of a run."""

_REPORT: Final = "case.json"
"""The name of the report in the folder of a case."""

_NOTE: Final = "Its variants v1 and v2 were changed on purpose: they are there to show reviews and fails."
"""The note on the page of the suite that comes with the package."""

_MOST_NAMED: Final = 8
"""The most files given to --changed that the page names."""

_NOT_UTF8: Final = re.compile("[\ud800-\udfff]")
"""Surrogates, which stand for non-UTF-8 bytes in names of files and cannot be encoded as UTF-8."""


@record
class SuiteRun:
    """The outcome of a run of a suite.

    ``folder`` is the folder of the run's reports and results. ``cases`` are the judged cases, in
    the suite's order. ``left_out`` are the names of the cases that depend on none of the
    ``changed`` files. ``missing`` are the names of the cases that were not judged because the run
    was stopped. ``complete`` says whether all requested cases were judged and retrained. ``on_film``
    is called before each film that is drawn for the page: with the name of the case, the number of its films
    so far, and that of all its films.
    """

    suite: Suite
    folder: Path
    cases: tuple[FinishedCase, ...]
    complete: bool
    left_out: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    changed: tuple[str, ...] = ()
    on_film: Callable[[str, int, int], None] = lambda *_: None


def json_text(outcome: SuiteRun) -> str:
    """Return the JSON report."""
    reports = [case.report for case in outcome.cases]
    data = document(
        outcome.suite, reports, complete=outcome.complete, left_out=outcome.left_out, missing=outcome.missing
    )
    return _encodable(json.dumps(data, indent=2, ensure_ascii=False)) + "\n"


def _junit_text(outcome: SuiteRun) -> str:
    return junit(outcome.suite, [case.report for case in outcome.cases], outcome.missing, len(outcome.left_out))


def _page_text(outcome: SuiteRun) -> str:
    """Return the HTML report as text."""
    suite = outcome.suite
    is_shipped = suite.path == SHIPPED
    contents = SuiteReport(
        suite="shipped" if is_shipped else suite.path.stem,
        seed=suite.seed if suite.played_cases else None,
        error=suite.error,
        versions=versions() if suite.played_cases else judging_versions(),
        cases=tuple(_reported_case(case, outcome) for case in outcome.cases),
        complete=outcome.complete,
        not_run=tuple(_cases_not_run(outcome)),
        note=_NOTE if is_shipped else "",
    )
    return _encodable(html_report(contents))


def _cases_not_run(outcome: SuiteRun) -> Iterator[NotRun]:
    """Yield the cases that were not judged in this run, with the reason, in the suite's order."""
    unaffected = "--changed names no file"
    if outcome.changed:
        names = short_list([f"`{file}`" for file in outcome.changed], _MOST_NAMED)
        unaffected = f"it depends on none of the files that --changed names: {names}"
    reasons = {
        **dict.fromkeys(
            outcome.missing,
            "the run was stopped before this case; run the same command again, without --fresh, to continue",
        ),
        **dict.fromkeys(outcome.left_out, unaffected),
    }
    for case in outcome.suite.cases:
        if case.name in reasons:
            yield NotRun(case.name, reasons[case.name], _earlier_verdict(outcome, case.name))


def _earlier_verdict(outcome: SuiteRun, name: str) -> CaseVerdict | None:
    """Return the verdict of an earlier run on a case, from the folder of the run; None if there is none."""
    path = case_folder(outcome.suite, name, outcome.folder / CASES) / _REPORT
    with suppress(OSError, ValueError, KeyError, TypeError, RecursionError):
        verdict = fileio.load_json(path, fileio.limits.REPORT)["content"]["verdict"]
        if verdict in get_args(CaseVerdict):
            return cast(CaseVerdict, verdict)
    return None


def _encodable(text: str) -> str:
    return _NOT_UTF8.sub("\N{REPLACEMENT CHARACTER}", text)


REPORTS: Final[Mapping[str, Callable[[SuiteRun], str]]] = {
    "--json": json_text,
    "--junit": _junit_text,
    "--html": _page_text,
}
"""The functions that make the reports, by option. The page is last, because it takes longest."""


def write_reports(outcome: SuiteRun, files: Mapping[str, Path]) -> Path | None:
    """Write the requested reports, and an HTML page into the folder of the run.

    ``files`` maps the option of each requested report, such as ``--json``, to the file to write.
    Return the path of the page that ``--html`` requests, or else of the page in the folder. If the
    run was stopped before its first case and no page was requested, write no page and return None.

    Raises:
        TltlError: TLT0005, a file cannot be written; errors from drawing the page.
    """
    texts: dict[str, str] = {}
    for option, text_of in REPORTS.items():
        if option in files:
            texts[option] = text_of(outcome)
            fileio.write_file(files[option], texts[option], f"name another place with {option}")
    if not outcome.cases and outcome.missing and "--html" not in files:
        return None
    page = texts.get("--html") or _page_text(outcome)
    fileio.write_files(outcome.folder, {PAGE: page}, "name another folder with --out")
    return files.get("--html", outcome.folder / PAGE)


def _reported_case(case: FinishedCase, outcome: SuiteRun) -> ReportedCase:
    """Return a case with the data that the HTML page needs to draw it."""
    if case.traces is not None:
        return ReportedCase(
            report=case.report,
            fspa=case.traces.fspa,
            clauses=_clause_texts(case.traces.clauses),
            before=case.traces.before.episodes,
            curves=example_curves(case.traces, case.report.explanation),
        )
    if case.prepared is None or case.reference is None:
        return ReportedCase(case.report)
    game, judge = case.prepared.level.game, case.prepared.setup.clause_judge
    folder = case_folder(outcome.suite, case.report.name, outcome.folder / CASES)
    episodes = _episodes(case.report, game, folder)
    # Some games show their levels only while they are played: take what the recordings show.
    level = game.played_level(case.prepared.level, (episodes[index] for index in sorted(episodes)))
    reported = ReportedCase(
        report=case.report,
        level=level,
        fspa=case.prepared.setup.fspa,
        clauses=_clause_texts(judge.clauses if judge else None),
        episodes=episodes,
        before=case.reference.episodes,
        baseline_level=_baseline_level(level, case.prepared, case.reference),
        curve=_curve(case, outcome.folder),
    )
    reported = with_plan(reported)
    if maps_of(reported) is not None and not reported.is_on_empty_plan:
        return reported
    films = _films(case.report, case.prepared, episodes, folder, outcome)
    return replace(
        reported,
        curves={index: episode_curves(index, episodes[index]) for index in episodes},
        films=films.pictures,
        film_notes=films.notes,
    )


def _clause_texts(clauses: traces.Clauses | None) -> tuple[str, ...]:
    """Return the clauses of a spec as texts; none if not all of them are known."""
    return tuple(part.text for part in clauses.parts) if clauses is not None and clauses.are_all else ()


def _films(
    report: CaseReport,
    prepared: PreparedCase,
    episodes: Mapping[int, RecordedEpisode],
    folder: Path,
    outcome: SuiteRun,
) -> CaseFilms:
    """Return the films of a case; those in its ``folder``, if it was played and recorded in the same way before."""
    place = prepared.setup.level, prepared.setup.variant.text
    recordings = {index: folder / name for index, name in report.recordings if index in episodes}
    draw = partial(
        episode_films, prepared.level.game, place, report.explanation, episodes, partial(outcome.on_film, report.name)
    )
    try:
        code = prepared.level.game.installed_code(prepared.level)
    except TltlError:
        # The game file has been edited since the case was played, and has an error: the notes beside the films say it.
        return draw()
    inputs = films_hash([to_json(prepared.played), to_json(report.explanation), code], place, recordings)
    return kept_films(folder, inputs, draw)


def _baseline_level(level: Level, ready: PreparedCase, reference: Reference) -> Level | None:
    """Return the level on which ``reference``, the recorded episodes of the baseline, was played.

    If the level's files have not changed since, this is ``level``, which was played now. Otherwise, the
    level is loaded from the texts in the baseline. Return None if this fails, or if the loaded level has
    no bounds.
    """
    if ready.played.files == reference.played.files:
        return level
    loaded = baseline_level(reference)
    return None if loaded is None or loaded.bounds is None else loaded


def _curve(case: FinishedCase, folder: Path) -> bytes:
    """Return the plot of the case's training, as PNG bytes; empty if there is none or it was removed."""
    if case.report.retrained is None:
        return b""
    with suppress(OSError):
        return (folder / case.report.retrained.policy).with_name("curve.png").read_bytes()
    return b""


def _episodes(report: CaseReport, game: Game[Any, Any], folder: Path) -> dict[int, RecordedEpisode]:
    """Read the recorded episodes of a case; return them by index. Damaged recordings are left out."""
    episodes: dict[int, RecordedEpisode] = {}
    for index, name in report.recordings:
        with suppress(TltlError):
            episodes[index] = game.read_episode(folder / name)
    return episodes
