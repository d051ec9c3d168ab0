"""Compute figures per family from the records of the compile table."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from benchmarks.measure import median
from benchmarks.reference import Reference
from benchmarks.store import Record

SOLVED_STATES = 600
SOLVED_MS = 5000.0
SOLVED_MB = 2048.0


@dataclass(frozen=True, slots=True)
class AtLeast:
    """A ratio, or a lower bound of it if the peer ran out of time."""

    value: float
    is_bound: bool

    def __str__(self) -> str:
        return f"{'≥ ' if self.is_bound else ''}{self.value:,.0f}"


@dataclass(frozen=True, slots=True)
class Family:
    """Medians over the formulas of a family; times in milliseconds.

    ``to_spot`` is our median over Spot's, on the formulas with both times, with Spot's times scaled
    to this machine by MONA's; ``to_spot_recorded`` uses Spot's times as recorded.
    ``ltlf2dfa_over_*`` is the median of the ratios of single formulas. LTLf2DFA solved
    ``ltlf2dfa_solved`` of ``ltlf2dfa_tried`` formulas.
    """

    name: str
    formulas: int
    minimal_ms: float
    guarded_ms: float
    build_ms: float
    mona_ms: float
    spot_ms: float
    to_spot: float
    to_spot_recorded: float
    ltlf2dfa_over_minimal: AtLeast | None
    ltlf2dfa_over_guarded: AtLeast | None
    ltlf2dfa_over_build: AtLeast | None
    ltlf2dfa_solved: int
    ltlf2dfa_tried: int


def families(records: Mapping[str, Record], references: Sequence[Reference], timeout_s: float) -> list[Family]:
    """Return a row per family, in the order of the corpus, for the formulas that were measured."""
    spot = spot_estimates(records, references)
    names = dict.fromkeys(reference.family for reference in references if reference.name in records)
    return [_family(name, records, references, spot, timeout_s) for name in names]


def spot_estimates(records: Mapping[str, Record], references: Sequence[Reference]) -> dict[str, float]:
    """Estimate Spot's times on this machine, in milliseconds, by formula.

    The estimate is Spot's recorded time, times MONA's time here, divided by MONA's recorded time. If
    MONA ran out of time, the median of these factors over the corpus is used.
    """
    factor = {
        reference.name: records[reference.name]["mona_ms"] / reference.mona_ms
        for reference in references
        if reference.mona_ms and "mona_ms" in records.get(reference.name, {})
    }
    usual = median(list(factor.values()))
    return {
        reference.name: reference.spot_ms * factor.get(reference.name, usual)
        for reference in references
        if reference.spot_ms is not None and reference.name in records and factor
    }


def _family(
    name: str,
    records: Mapping[str, Record],
    references: Sequence[Reference],
    spot: Mapping[str, float],
    timeout_s: float,
) -> Family:
    members = [reference.name for reference in references if reference.family == name and reference.name in records]
    family_records = [records[member] for member in members]
    comparable = [member for member in members if member in spot and "minimal_ms" in records[member]]
    spot_ms = median([spot[member] for member in comparable])
    attempted = [
        record for record in family_records if "ltlf2dfa_ms" in record or record.get("ltlf2dfa_failed") != "left out"
    ]
    return Family(
        name=name,
        formulas=len(members),
        minimal_ms=_median_of(family_records, "minimal_ms"),
        guarded_ms=_median_of(family_records, "guarded_ms"),
        build_ms=_median_of(family_records, "build_ms"),
        mona_ms=_median_of(family_records, "mona_ms"),
        spot_ms=spot_ms,
        to_spot_recorded=_over_recorded_spot(
            [reference for reference in references if reference.name in comparable], records
        ),
        to_spot=median([records[member]["minimal_ms"] for member in comparable]) / spot_ms
        if comparable
        else float("nan"),
        ltlf2dfa_over_minimal=_speed_up(family_records, "minimal_ms", timeout_s),
        ltlf2dfa_over_guarded=_speed_up(family_records, "guarded_ms", timeout_s),
        ltlf2dfa_over_build=_speed_up(family_records, "build_ms", timeout_s),
        ltlf2dfa_solved=sum("ltlf2dfa_ms" in record for record in family_records),
        ltlf2dfa_tried=sum("ltlf2dfa_ms" in record or "ltlf2dfa_failed" in record for record in attempted),
    )


def _over_recorded_spot(references: Sequence[Reference], records: Mapping[str, Record]) -> float:
    recorded = [reference.spot_ms for reference in references if reference.spot_ms is not None]
    ours = [records[reference.name]["minimal_ms"] for reference in references]
    return median(ours) / median(recorded) if recorded else float("nan")


def _median_of(records: Iterable[Record], field: str) -> float:
    return median([record[field] for record in records if field in record])


def _speed_up(records: Iterable[Record], field: str, timeout_s: float) -> AtLeast | None:
    """Return the median of LTLf2DFA's time over ours; if LTLf2DFA ran out of time, its time limit counts.

    Return None if no formula has both times. Of an even number of ratios, the lower middle one is
    taken, so that a bound stays a bound.
    """
    ratios: list[tuple[float, bool]] = []
    for record in records:
        if field in record and "ltlf2dfa_ms" in record:
            ratios.append((record["ltlf2dfa_ms"] / record[field], False))
        elif field in record and str(record.get("ltlf2dfa_failed", "")).startswith("over"):
            ratios.append((timeout_s * 1e3 / record[field], True))
    if not ratios:
        return None
    ratios.sort()
    value, _ = ratios[(len(ratios) - 1) // 2]
    # The true ratio of a bound below the middle may be above it, so then the middle is only a bound, too.
    return AtLeast(value, any(is_bound for ratio, is_bound in ratios if ratio <= value))


def unsolved(records: Mapping[str, Record]) -> list[str]:
    """Return the formulas with at most 600 states whose complete build took over 5 s or 2 GB, or failed."""
    return [
        name
        for name, record in records.items()
        if (record["states_expected"] or SOLVED_STATES + 1) <= SOLVED_STATES
        and (record.get("build_ms", SOLVED_MS) >= SOLVED_MS or record["build_mb"] >= SOLVED_MB)
    ]


def wrong_sizes(records: Mapping[str, Record]) -> list[str]:
    """Return the formulas for which our size differs from the reference's or from MONA's."""
    return [
        name
        for name, record in records.items()
        if "states" in record
        and any(
            record[field] not in (None, record["states"])
            for field in ("states_expected", "mona_states")
            if field in record
        )
    ]
