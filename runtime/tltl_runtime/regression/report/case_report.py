"""The report on a case: verdict, figures, reasons and accounts, as it is written and read again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from tltl_runtime.evaluation.figures import Figures, figures_of
from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.explain.explain import Finding, ends, findings
from tltl_runtime.regression.explain.reasons import edits, obstacles, reasons
from tltl_runtime.regression.retrain.retrained import Retrained
from tltl_runtime.regression.suite.level_texts import level_texts
from tltl_runtime.regression.suite.suite import Case, Thresholds
from tltl_runtime.regression.verdict.baseline import Identity
from tltl_runtime.regression.verdict.play import Result
from tltl_runtime.regression.verdict.verdict import Change, Judgement, Verdict
from tltl_runtime.stealth.levels.place import shown_variant
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


@record
class CaseReport:
    """What a case came to; of one that cannot be played there are ``causes`` alone.

    ``causes`` are sentences on why it has its verdict, ``explanation`` those with the episodes that they speak of,
    ``edits`` say what is otherwise than in the baseline.  ``certain`` and ``rate_interval`` are those of a
    :class:`~tltl_runtime.regression.verdict.verdict.Judgement`, ``baseline`` has the figures that it is compared with.
    """

    name: str
    level: str
    variant: str
    verdict: Verdict
    causes: tuple[str, ...]
    certain: bool = True
    rate_interval: tuple[float, float] = (0.0, 1.0)
    figures: Figures | None = None
    baseline: Figures | None = None
    changes: tuple[Change, ...] = ()
    explanation: tuple[Finding, ...] = ()
    edits: tuple[str, ...] = ()
    played: Identity | None = None
    reference: Identity | None = None
    accounts: tuple[Account, ...] = ()
    recordings: tuple[tuple[int, str], ...] = ()
    """Of which episodes there are recordings, and the names of their files."""
    retrained: Retrained | None = None
    """What a training from its policy came to, None where none was asked for or needed."""
    told: str = ""
    """The headline where it is none of the reasons as they stand; empty: the first of them."""
    fault_at: tuple[str, int] | None = None
    """Of a case that cannot be played, the file and the line, from 1 on, of what is wrong."""

    @property
    def headline(self) -> str:
        """What says most where there is room for one sentence."""
        return self.told or next(iter(self.reasons), "")

    @property
    def reasons(self) -> tuple[str, ...]:
        """All that is said of it, the weightiest first."""
        return (*self.causes, *(finding.text for finding in self.explanation), *self.edits)


def report_on(result: Result) -> CaseReport:
    """The report on a case that was played."""
    case, setup = result.ready.case, result.ready.setup
    now = [each.account for each in result.episodes]
    before = result.reference.accounts
    level, outdated = result.ready.level, result.ready.outdated
    said = tuple(reasons(result.judgement, case.thresholds, now, before))
    blocked = tuple(obstacles(level, setup.fspa))
    figures, baseline = figures_of(now), figures_of(before)
    # How a case that is only not certain fails as rarely as before says nothing of its verdict.
    is_worse = result.judgement.verdict == "fail" or figures.pass_rate < baseline.pass_rate
    failed = next(ends(level, setup.fspa, now, before), None) if is_worse else None
    return CaseReport(
        name=case.name,
        level=level.name,
        variant=level.variant,
        # By a spec that nobody asks for any more nothing passes.
        verdict="review" if outdated and result.judgement.verdict == "pass" else result.judgement.verdict,
        certain=result.judgement.certain,
        rate_interval=result.judgement.rate_interval,
        figures=figures,
        baseline=baseline,
        changes=result.judgement.changes,
        causes=(*([outdated] if outdated else []), *said[:1], *blocked, *said[1:]),
        told=outdated or next(iter(blocked), None) or _headline(result.judgement, case.thresholds, said, failed),
        explanation=findings(level, setup.fspa, now, before),
        edits=tuple(_edits(result)),
        played=result.ready.played,
        reference=result.reference.played,
        accounts=tuple(now),
    )


def _edits(result: Result) -> Iterator[str]:
    """What is otherwise than in the baseline; of a file that was edited meanwhile it is not known what."""
    ready, before = result.ready, result.reference
    texts = level_texts(ready.setup.level, ready.setup.variant, ready.played.files)
    return edits(ready.played, before.played, ready.changes, texts, before.texts)


def _headline(judgement: Judgement, thresholds: Thresholds, said: Sequence[str], failed: Finding | None) -> str:
    """Of a case that may meet its spec too rarely how it fails, of one whose figures changed that, else how often."""
    if failed and judgement.rate_interval[0] < thresholds.pass_rate:
        return failed.text.partition("; ")[0]
    return said[1] if len(said) > 1 else said[0]


def report_on_broken(case: Case, error: TltlError) -> CaseReport:
    """The report on a case that cannot be played, which is a failure of the level and not of the suite."""
    said = ("it cannot be played", *map(_said, error.diagnostics))
    # As a level that loads calls it: the place of an overlay's file is no part of a report.
    variant = shown_variant(case.variant)
    name = Path(case.level).stem
    return CaseReport(case.name, name, variant, "fail", said, told=": ".join(said[:2]), fault_at=_place(error))


def report_on_edited(case: Case, error: TltlError) -> CaseReport:
    """The report on a case whose level was edited while it was played, so that nothing can be said of it."""
    variant = shown_variant(case.variant)
    said = tuple(map(_said, error.diagnostics))
    return CaseReport(case.name, Path(case.level).stem, variant, "review", said, certain=False)


def _said(found: Diagnostic) -> str:
    """A diagnostic in one line, with its place."""
    where = message = ""
    if found.labels:
        label = found.labels[0]
        where = f"{label.source.name}:{label.source.position(label.span.start)[0]}: "
        message = f": {label.message}" if label.message else ""
    return f"{where}{found.code}, {found.title}{message}" + (f" ({found.help})" if found.help else "")


def _place(error: TltlError) -> tuple[str, int] | None:
    """The file and the line of the first fault that has a place."""
    label = next((each.labels[0] for each in error.diagnostics if each.labels), None)
    return (label.source.name, label.source.position(label.span.start)[0]) if label else None
