"""The order of the reasons of a verdict: first the one that a person would give first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, Literal

from tltl_runtime.regression.explain.explain import Finding, FindingKind
from tltlc.api import record

ReasonKind = Literal["main", "edit", "cause", "finding", "trace", "figure", "version"]
"""What a reason is about.

- ``main``: what makes a verdict on play impossible, or what no player can reach;
- ``edit``: what has changed since the baseline;
- ``cause``: the pass rate, and sentences that belong to no other kind;
- ``finding``: what the policy does, mostly differently from the baseline;
- ``trace``: which recorded traces fail, and at which step;
- ``figure``: the means of progress and reward;
- ``version``: versions of software that are not those of the baseline.
"""

_TELLING: Final[tuple[FindingKind, ...]] = ("unreached", "end", "stage", "length", "region")
"""The kinds of findings that explain a verdict, most important first. The others give details."""


@record
class Reason:
    """A reason of a verdict: its sentence, and the finding that the sentence is from, if any.

    ``short`` is the sentence without details.
    """

    kind: ReasonKind
    text: str
    short: str
    finding: Finding | None = None


def telling_findings(findings: Sequence[Finding], *, is_worse: bool) -> list[Finding]:
    """Return the findings that explain a verdict, most important first.

    If a case fails no more often than before, which is not ``is_worse``, its failures explain nothing.
    """
    kinds = [kind for kind in _TELLING if is_worse or kind != "end"]
    return sorted((finding for finding in findings if finding.kind in kinds), key=lambda found: kinds.index(found.kind))


def ordered_reasons(
    main: Sequence[str],
    edits: Sequence[str],
    causes: Sequence[str],
    findings: Sequence[Finding],
    figures: Sequence[str],
    versions: Sequence[str],
    traces: Sequence[str] = (),
    *,
    is_worse: bool,
) -> Iterator[Reason]:
    """Yield the reasons of a verdict in order; :data:`ReasonKind` has their kinds.

    First comes what happens, then what has changed, then more on what happens, with the ``traces`` that
    fail. The pass rate comes next, then details, progress, and reward. Versions are last. ``is_worse``
    says whether the case fails more often than before.
    """
    telling = telling_findings(findings, is_worse=is_worse)
    happens = [*(_plain("main", text) for text in main), *map(_found, telling)]
    yield from happens[:1]
    yield from (_plain("edit", text) for text in edits)
    yield from happens[1:]
    yield from (_plain("trace", text) for text in traces)
    yield from (_plain("cause", text) for text in causes)
    yield from (_found(finding) for finding in findings if finding not in telling)
    yield from (_plain("figure", text) for text in figures)
    yield from (_plain("version", text) for text in versions)


def _plain(kind: ReasonKind, text: str) -> Reason:
    return Reason(kind, text, text)


def _found(finding: Finding) -> Reason:
    return Reason("finding", finding.text, finding.short or finding.text, finding)
