"""The report on a case of a regression test: verdict, statistics, reasons and episodes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, Literal

from tltl_runtime.evaluation.figures import Figures, figures_of
from tltl_runtime.game.level_name import level_stem
from tltl_runtime.game.mentions import NO_MENTIONS, Mentions, union
from tltl_runtime.regression.explain.explain import Finding, findings, new_failures
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode, summaries_of
from tltl_runtime.regression.explain.phrase import Phrase
from tltl_runtime.regression.report.reason_order import Reason, ordered_reasons, telling_findings
from tltl_runtime.regression.report.reasons import edits, is_unchanged, obstacles, reasons, version_changes
from tltl_runtime.regression.report.retraining_result import RetrainingResult
from tltl_runtime.regression.suite.suite import Case
from tltl_runtime.regression.verdict.baseline import Identity
from tltl_runtime.regression.verdict.level_texts import level_texts
from tltl_runtime.regression.verdict.play import JudgedCase
from tltl_runtime.regression.verdict.verdict import CaseVerdict, FigureChange
from tltlc.api import Diagnostic, TltlError, record

_UNCHANGED: Final = (
    "nothing has changed since the baseline: the level, the spec, the policy and all versions are those of the baseline"
)


CaseStatus = Literal[
    "unfinished",
    "impossible",
    "much_less_often",
    "unplayable",
    "unfinished_before",
    "too_seldom_before",
    "outdated",
    "less_often",
    "changed",
    "uncertain",
    "low_rate",
    "as_before",
]
"""What has become of a case.

- ``unfinished``: it fails, no episode meets the spec, and episodes of the baseline do; ``impossible``: and
  certainly no player can meet the spec;
- ``much_less_often``: it fails, and some episodes meet the spec, but certainly a smaller share than in the
  baseline;
- ``unplayable``: it fails because it cannot be played or judged;
- ``unfinished_before``: it fails, and no episode meets the spec, now as in the baseline;
- ``too_seldom_before``: it fails, but perhaps no more often than in the baseline;
- ``outdated``: the spec has changed since the policy was trained, so the verdict is about the old spec;
- ``less_often``: it needs a review, and certainly a smaller share of episodes meets the spec than in the
  baseline;
- ``changed``: it needs a review, because something else has certainly changed;
- ``uncertain``: it needs a review, because it may have changed;
- ``low_rate``: it needs a review only because it is not certain that enough episodes meet the spec; nothing
  has changed that counts;
- ``as_before``: it passes.
"""


@record
class TraceNames:
    """The ``names`` of recorded traces, in the order of their indices.

    ``place`` lists the files and folders that contain the traces, for example ``traces/old, a.csv``.
    ``unread`` is the number of traces there that cannot be judged; they are not in ``names``.
    """

    place: str
    names: tuple[str, ...]
    unread: int = 0


@record
class CaseTraces:
    """The recorded traces of a case.

    ``now`` are the traces to judge, ``before`` are those of the baseline, and ``spec`` is the name
    of the spec that judges both.
    """

    spec: str
    now: TraceNames
    before: TraceNames


@record
class CaseReport:
    """The report on a case.

    - ``main`` are sentences that come before all other reasons: the spec was changed, or no player can
      reach what it asks for.
    - ``causes`` are sentences that justify the verdict, such as that on the pass rate.
    - ``figure_changes`` are sentences on progress and reward.
    - ``certain``, ``rate_interval`` and ``changes`` are as in
      :class:`~tltl_runtime.regression.verdict.verdict.Judgement`.
    - ``figures`` are the statistics of the played episodes, ``baseline`` those of the episodes in the
      baseline.
    - ``explanation`` says what the policy does differently from the baseline.
    - ``new_failures`` are findings on ways to fail that the baseline does not have, whatever the verdict is.
    - ``edits`` are sentences about what has changed since the baseline: files and overlays (files that
      change a level). If a case does not pass and nothing has changed, they say so.
    - ``version_changes`` are sentences about other versions of software than those of the baseline.
    - ``is_impossible`` says that certainly no player can meet the spec.
    - ``descriptions`` are texts in which the designer describes the overlays. They are also in
      ``edits``.
    - ``mentions`` names the things and regions of the level that ``main`` and ``edits`` mention, except
      those that only ``descriptions`` mention.
    - ``played`` and ``reference`` identify what was played now and for the baseline.
    - ``episodes`` are the played episodes, or the judged traces as episodes.
    - ``lost`` is the sentence, one of ``causes``, that says how many episodes were lost with their
      games; empty if none was.
    - ``traces`` has the names of the traces of a case of recorded traces. ``level`` and ``variant``
      of such a case are empty. For other cases, ``traces`` is None.

    A case that cannot be played or judged has no figures and no episodes.
    """

    name: str
    level: str
    variant: str
    verdict: CaseVerdict
    causes: tuple[str, ...]
    certain: bool = True
    rate_interval: tuple[float, float] = (0.0, 1.0)
    figures: Figures | None = None
    baseline: Figures | None = None
    changes: tuple[FigureChange, ...] = ()
    explanation: tuple[Finding, ...] = ()
    edits: tuple[str, ...] = ()
    mentions: Mentions = NO_MENTIONS
    descriptions: tuple[str, ...] = ()
    played: Identity | None = None
    reference: Identity | None = None
    episodes: tuple[ExplainedEpisode, ...] = ()
    recordings: tuple[tuple[int, str], ...] = ()
    """The index of each recorded episode, with the name of its file."""
    retrained: RetrainingResult | None = None
    """The result of retraining the policy; None if it was not requested or not needed."""
    traces: CaseTraces | None = None
    chosen_headline: str = ""
    """The headline; empty if the first of ``reasons`` is the headline."""
    fault_at: tuple[str, int] | None = None
    """The file and the line, from 1, of the error that keeps the case from being played; None without one."""
    lost: str = ""
    main: tuple[str, ...] = ()
    figure_changes: tuple[str, ...] = ()
    version_changes: tuple[str, ...] = ()
    new_failures: tuple[Finding, ...] = ()
    failing_traces: tuple[str, ...] = ()
    """For recorded traces: which of them fail, with the clause and the step; at most a few, and how many more."""
    is_impossible: bool = False
    is_outdated: bool = False
    """Whether the spec has changed since the policy was trained, and the policy's old spec judges the case."""

    @property
    def headline(self) -> str:
        """The most important sentence, and what has changed; empty if there is none."""
        return self.chosen_headline or next(iter(self.reasons), "")

    @property
    def reasons(self) -> tuple[str, ...]:
        """All sentences of the report, in the order in which a person would give them."""
        return tuple(reason.text for reason in self.ordered_reasons)

    @property
    def ordered_reasons(self) -> tuple[Reason, ...]:
        """All reasons, in the order of :func:`~tltl_runtime.regression.report.reason_order.ordered_reasons`."""
        return tuple(
            ordered_reasons(
                self.main,
                self.edits,
                self.causes,
                self.explanation,
                self.figure_changes,
                self.version_changes,
                self.failing_traces,
                is_worse=_is_worse(self.verdict, self.figures, self.baseline),
            )
        )

    @property
    def has_new_failure(self) -> bool:
        """Whether the case passes, but fails in a way in which no episode of the baseline fails."""
        return self.verdict == "pass" and bool(self.new_failures)

    @property
    def status(self) -> CaseStatus:
        """What has become of the case, for people: see :data:`CaseStatus`."""
        if self.verdict == "pass":
            return "as_before"
        if self.figures is None:
            return "unplayable" if self.verdict == "fail" else "uncertain"
        if self.is_outdated:
            return "outdated"
        return self._failed_status(self.figures) if self.verdict == "fail" else self._reviewed_status()

    def _failed_status(self, figures: Figures) -> CaseStatus:
        is_never_met = figures.pass_rate == 0.0
        if self.baseline is not None and self.baseline.pass_rate <= self.rate_interval[1]:
            is_never_met = is_never_met and self.baseline.pass_rate == 0.0
            return "unfinished_before" if is_never_met else "too_seldom_before"
        if not is_never_met:
            return "much_less_often"
        return "impossible" if self.is_impossible else "unfinished"

    def _reviewed_status(self) -> CaseStatus:
        low, high = self.rate_interval
        before = self.baseline.pass_rate if self.baseline else 1.0
        if before > high:
            return "less_often"
        if self.changes or before < low:
            return "changed"
        # Before all reasons, traces have sentences that say why there is no verdict.
        return "uncertain" if self.figure_changes or self.main else "low_rate"


def report_on(result: JudgedCase) -> CaseReport:
    """Return the report on a case that was played."""
    case, setup = result.prepared.case, result.prepared.setup
    now = [episode.explained for episode in result.episodes]
    before = result.reference.episodes
    level, outdated = result.prepared.level, result.prepared.outdated
    summaries, summaries_before = summaries_of(now), summaries_of(before)
    played, reference = result.prepared.played, result.reference.played
    compared = reference.variant if reference.variant != played.variant else ""
    met, *figure_changes = reasons(result.judgement, case.thresholds, summaries, summaries_before, reference=compared)
    blocked = tuple(obstacles(level, setup.fspa))
    # A case cannot pass while an outdated spec judges it.
    verdict = "review" if outdated and result.judgement.verdict == "pass" else result.judgement.verdict
    changes = tuple(_edits(result))
    if verdict != "pass" and not changes and not outdated and is_unchanged(played, reference):
        changes = (Phrase(_UNCHANGED),)
    figures, baseline = figures_of(summaries), figures_of(summaries_before)
    explanation = findings(level, setup.fspa, now, before)
    new = new_failures(level, setup.fspa, now, before)
    main = (*([outdated] if outdated else []), *(obstacle.text for obstacle in blocked))
    return CaseReport(
        name=case.name,
        level=level.name,
        variant=level.variant,
        verdict=verdict,
        certain=result.judgement.certain,
        rate_interval=result.judgement.rate_interval,
        figures=figures,
        baseline=baseline,
        changes=result.judgement.changes,
        main=main,
        causes=(met, *([result.lost.line] if result.lost else [])),
        figure_changes=tuple(figure_changes),
        chosen_headline=headline(
            result.judgement.verdict,
            main,
            telling_findings(explanation, is_worse=_is_worse(verdict, figures, baseline)),
            (met, *figure_changes),
            () if outdated else changes,
            new,
            is_met=result.judgement.rate_interval[0] >= case.thresholds.pass_rate,
        ),
        explanation=explanation,
        new_failures=new,
        edits=tuple(edit.text for edit in changes),
        version_changes=tuple(version_changes(played, reference)),
        is_impossible=bool(blocked) and level.game.is_infeasible(level, setup.fspa),
        is_outdated=bool(outdated),
        mentions=union(sentence.mentions for sentence in (*blocked, *changes)),
        descriptions=result.prepared.changes,
        played=result.prepared.played,
        reference=result.reference.played,
        episodes=tuple(now),
        lost=result.lost.line if result.lost else "",
    )


def _is_worse(verdict: CaseVerdict, figures: Figures | None, baseline: Figures | None) -> bool:
    """Whether a case fails more often than before.

    Otherwise its failures do not explain an uncertain verdict.
    """
    return verdict == "fail" or not (figures and baseline and figures.pass_rate >= baseline.pass_rate)


def _edits(result: JudgedCase) -> Iterator[Phrase]:
    """Yield the sentences that are ``edits`` in a :class:`CaseReport`.

    The sentence on a changed file names its changed keys, unless the file was edited again after
    the case was set up.
    """
    prepared, before = result.prepared, result.reference
    texts = level_texts(prepared.setup.level, prepared.setup.variant, prepared.played.files)
    return edits(prepared.played, before.played, prepared.changes, texts, before.texts)


def headline(
    verdict: CaseVerdict,
    main: Sequence[str],
    telling: Sequence[Finding],
    statistics: Sequence[str],
    changes: Sequence[Phrase],
    new: Sequence[Finding],
    *,
    is_met: bool,
) -> str:
    """Return what a case's headline says: its most important sentence, then the first of its ``changes``.

    The most important sentence is the first one that exists of ``main``, the ``telling`` findings, and the
    ``statistics``. If the pass rate ``is_met``, a changed figure counts more than the rate. The
    ``statistics`` are the sentences of :func:`~tltl_runtime.regression.report.reasons.reasons`: the first
    is about the pass rate, the others are about changed figures.

    Of a case that passes, the headline has the first way to fail that is ``new``, if there is one, and
    the pass rate.
    """
    if verdict == "pass" and not main:
        return "; ".join((*(new_failure_text(finding) for finding in new[:1]), statistics[0]))
    most_important = (
        *main,
        *(finding.short or finding.text for finding in telling),
        *(statistics[1:] if is_met else ()),
        *statistics,
    )
    return "; ".join((most_important[0], *(change.text for change in changes[:1])))


def new_failure_text(finding: Finding) -> str:
    """Return the sentence on a way to fail that the baseline does not have."""
    return f"new failure: {finding.text}"


def report_on_broken(case: Case, error: TltlError) -> CaseReport:
    """Return the report on a case that cannot be played because of ``error``.

    The verdict is ``fail``, because the error is in a file that the case tests, not in the suite.
    """
    causes = ("it cannot be played", *map(one_line, error.diagnostics))
    # Name the variant as for a level that loads, without the paths of overlay files.
    name = level_stem(case.level)
    return CaseReport(
        case.name,
        name,
        case.variant.title,
        "fail",
        causes,
        chosen_headline=": ".join(causes[:2]),
        fault_at=error_location(error),
    )


def report_on_edited(case: Case, error: TltlError) -> CaseReport:
    """Return the report on a case whose level was edited while the case was played.

    The verdict is ``review``, and there are no statistics. ``error`` names the edited files.
    """
    causes = tuple(map(one_line, error.diagnostics))
    return CaseReport(case.name, level_stem(case.level), case.variant.title, "review", causes, certain=False)


def one_line(diagnostic: Diagnostic) -> str:
    """Format a diagnostic in one line: ``FILE:LINE: CODE, TITLE: MESSAGE (HELP)``.

    Parts that the diagnostic does not have are left out.
    """
    location = message = ""
    if diagnostic.labels:
        label = diagnostic.labels[0]
        location = f"{label.source.name}:{label.source.position(label.span.start)[0]}: "
        message = f": {label.message}" if label.message else ""
    return f"{location}{diagnostic.code}, {diagnostic.title}{message}" + (
        f" ({diagnostic.help})" if diagnostic.help else ""
    )


def error_location(error: TltlError) -> tuple[str, int] | None:
    """Return the first file and line, from 1, that an error points to; None if it points to no file."""
    label = next((diagnostic.labels[0] for diagnostic in error.diagnostics if diagnostic.labels), None)
    return (label.source.name, label.source.position(label.span.start)[0]) if label else None
