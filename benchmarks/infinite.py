"""Measure Rabin automata of formulas over infinite traces, and compare their sizes with recorded sizes of peers."""

from __future__ import annotations

import csv
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Any, Final

from benchmarks.markdown import met_or_missed, table
from benchmarks.store import Record, Store, measure_missing, source_digest
from tests.reference_formulas import read_formula
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.infinite.analysis import analysis_of_rabin
from tltlc.automaton.infinite.construct import rabin
from tltlc.automaton.work import DEFAULT_WORK, Work

SECTION = "infinite"
TABLE: Final = Path(__file__).with_name("infinite.tsv")
"""Formulas with the recorded numbers of states of peers; a cell is empty if a peer was not run."""

CORPORA: Final[Mapping[str, str]] = {
    "families": "families of our own, all states",
    "owl": "Owl's test corpus, without traps, as its own figures are",
}
PEERS: Final[Mapping[str, str]] = {
    "spot_parity_states": "Spot, deterministic parity",
    "owl_states": "Owl, deterministic Rabin",
    "rabinizer31_states": "Rabinizer 3.1, Rabin on transitions",
}
COLUMNS: Final = ("states", "without", "ms")
"""The lists in a record, each with a value for each formula of its corpus, in the order of the table."""
_TRIAL: Final = 4448
"""The number of states, over all formulas of Owl's corpus, in an earlier trial of this construction."""
_MEDIAN_MS: Final = 10.0
_SLOWEST_S: Final = 10.0


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Build the automata of each corpus that has no record, or only one that other code made."""
    code = {"source": source_digest("tltlc")}
    measure_missing(
        store, SECTION, CORPORA, lambda name: {**_measure_corpus(name), **code}, say, field="ms", current=code
    )


def _measure_corpus(corpus: str) -> Record:
    measured = [_automaton_figures(row["formula"]) for row in _table_rows(corpus)]
    return {column: [figures[column] for figures in measured] for column in COLUMNS}


def _table_rows(corpus: str) -> list[dict[str, str]]:
    """Return the rows of a corpus in the table of peers."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        return [row for row in csv.DictReader(file, delimiter="\t") if row["corpus"] == corpus]


def _automaton_figures(text: str) -> dict[str, Any]:
    """Return the number of states of a formula's automaton, with and without traps, and CPU milliseconds."""
    formula = read_formula(text)
    with recursion_room():
        start = time.process_time()
        automaton = rabin(formula)
        spent_s = time.process_time() - start
    analysis = analysis_of_rabin(automaton, Work(DEFAULT_WORK))
    traps = sum(analysis.verdict(state) == "violated" for state in range(len(automaton.steps)))
    # If the automaton has only a trap, the trap counts.
    without = max(1, len(automaton.steps) - traps)
    return {"states": len(automaton.steps), "without": without, "ms": round(1e3 * spent_s, 3)}


def _rows(corpus: str, record: Record) -> list[dict[str, Any]]:
    """Return for each formula of a corpus our figures, and the figures of the peers that were run.

    Raises:
        ValueError: the table has other formulas than those that were measured.
    """
    if any(column not in record for column in COLUMNS):
        return []
    measured = zip(*(record[column] for column in COLUMNS), strict=True)
    return [
        {
            **dict(zip(COLUMNS, figures, strict=True)),
            **{name: int(row[name]) for name in (*PEERS, "rabinizer31_wall_ms") if row[name]},
        }
        for figures, row in zip(measured, _table_rows(corpus), strict=True)
    ]


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Yield the rows of the table of goals, once both corpora were measured."""
    rows = {name: _rows(name, records.get(name, {})) for name in CORPORA}
    if not all(rows.values()):
        return
    totals = {name: _totals(name, rows[name]) for name in CORPORA}
    is_fewest = all(ours < theirs for peers in totals.values() for ours, theirs, *_ in peers.values())
    figure = "; ".join(
        f"{ours} against {theirs} ({PEERS[peer].partition(',')[0]})"
        for peers in totals.values()
        for peer, (ours, theirs, *_) in peers.items()
    )
    yield "over infinite traces fewer states in all than Spot, Owl and Rabinizer", figure, met_or_missed(is_fewest)
    ours = sum(row["without"] for row in rows["owl"])
    yield f"no more than {_TRIAL} states on Owl's corpus", str(ours), met_or_missed(ours <= _TRIAL)
    times = [row["ms"] for name in CORPORA for row in rows[name]]
    figure = f"median {median(times):.1f} ms, slowest {max(times) / 1e3:.1f} s"
    met = median(times) < _MEDIAN_MS and max(times) < 1e3 * _SLOWEST_S
    yield (
        f"a Rabin automaton in {_MEDIAN_MS:.0f} ms (median), and none in more than {_SLOWEST_S:.0f} s",
        figure,
        met_or_missed(met),
    )


def section(records: Mapping[str, Record]) -> str:
    """Return the section on infinite traces; empty without measurements."""
    body = []
    times = []
    for name, title in CORPORA.items():
        rows = _rows(name, records.get(name, {}))
        for peer, (ours, theirs, smaller, equal, larger) in _totals(name, rows).items():
            body.append((title, len(rows), ours, PEERS[peer], theirs, f"{smaller} / {equal} / {larger}"))
        if rows:
            times_ms = sorted(row["ms"] for row in rows)
            rabinizer = [row["rabinizer31_wall_ms"] for row in rows if "rabinizer31_wall_ms" in row]
            rabinizer_ms = f"{median(rabinizer):.0f}" if rabinizer else "–"
            times.append(
                (
                    title,
                    f"{median(times_ms):.1f}",
                    f"{times_ms[int(0.95 * len(times_ms))]:.0f}",
                    f"{times_ms[-1]:.0f}",
                    rabinizer_ms,
                )
            )
    if not body:
        return ""
    sizes = table(("corpus", "formulas", "states", "peer", "its states", "smaller / equal / larger"), body)
    spent_table = table(("corpus", "median, ms", "95 %, ms", "slowest, ms", "Rabinizer's process, median, ms"), times)
    return f"""
## Infinite traces

`python -m benchmarks --only {SECTION}` builds the deterministic Rabin automata of two corpora. The figures of peers
were recorded earlier, in `benchmarks/infinite.tsv`: Spot 2.14, Owl's own figures for its `symmetric` portfolio, and
Rabinizer 3.1, whose time is that of its whole process with a Java virtual machine. Our time is CPU time in one
process, from a formula in memory to the automaton. *Smaller*: formulas for which our automaton has fewer states.

{sizes}

{spent_table}
"""


def _totals(corpus: str, rows: Sequence[Mapping[str, Any]]) -> dict[str, tuple[int, int, int, int, int]]:
    """Return for each peer: our states, its states, and for how many formulas ours are fewer, as many or more."""
    totals = {}
    for peer in PEERS:
        pairs = [(row["states" if corpus == "families" else "without"], row[peer]) for row in rows if peer in row]
        if pairs:
            totals[peer] = (
                sum(ours for ours, _ in pairs),
                sum(theirs for _, theirs in pairs),
                sum(ours < theirs for ours, theirs in pairs),
                sum(ours == theirs for ours, theirs in pairs),
                sum(ours > theirs for ours, theirs in pairs),
            )
    return totals
