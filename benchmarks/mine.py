"""Measure how well ``tltlc mine`` and peers that learn formulas recover specs that were planted in traces."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from statistics import median
from typing import Any, Final

from benchmarks.markdown import met_or_missed, table
from benchmarks.mine_peers import LearnedFormula, enumerate_formulas, has_scarlet, scarlet
from benchmarks.mine_traces import PlantedSpec, evidence, paper_specs, random_spec
from benchmarks.store import Record, Store, measure_missing, source_digest
from tltlc.automaton.compare import are_equivalent
from tltlc.automaton.fspa import Fspa
from tltlc.core.source import SourceFile
from tltlc.pipeline import CompileOptions, compile_source
from tltlc.tools.diff.relation import compare
from tltlc.tools.mine.columns import ColumnKind
from tltlc.tools.mine.confirm import confirm
from tltlc.tools.mine.evidence import Evidence
from tltlc.tools.mine.search import MiningOptions, SpecSearch
from tltlc.tools.mine.vocabulary import vocabulary_of_columns

SECTION = "mine"
TRACES, COUNTEREXAMPLES = 40, 80
NOISE: Final = 0.05
_SEED: Final = 1
_TOP: Final = 5
_RANDOM: Final = 20
_MOST_PEER_S: Final = 20.0
_LEAST_FOUND: Final = 20
"""At least this many specs should be at rank 1, in traces without noise."""
_FACTOR: Final = 10.0

SPECS: Final[Mapping[str, PlantedSpec]] = {
    spec.name: spec for spec in (*paper_specs(), *(random_spec(number) for number in range(_RANDOM)))
}
PEERS: Final = {"enumeration": "plain enumeration", "scarlet": "Scarlet 0.0.4"}


def measure(store: Store, timeout_s: float, say: Callable[[str], None]) -> None:
    """Plant and recover each spec that has no record, or only one that other code made."""
    code = {"source": source_digest("tltlc/tools/mine", "benchmarks/mine_peers.py", "benchmarks/mine_traces.py")}
    if not has_scarlet():
        say("mine: Scarlet is left out, since it is not installed (benchmarks/requirements.txt)")
    peer_s = min(timeout_s, _MOST_PEER_S)
    measure_missing(
        store,
        SECTION,
        SPECS,
        lambda name: {**_measure_spec(SPECS[name], peer_s), **code},
        say,
        field="ours",
        current=code,
    )


def _measure_spec(spec: PlantedSpec, peer_s: float) -> Record:
    clean, noisy = (evidence(spec, TRACES, COUNTEREXAMPLES, seed=_SEED, noise=noise) for noise in (0.0, NOISE))
    planted_fspa = spec.automaton()
    record: Record = {
        "clauses": list(spec.clauses),
        "limit_s": peer_s,
        "ours": _ours(clean, planted_fspa, 1.0),
        "noisy": _ours(noisy, planted_fspa, 1.0 - 2 * NOISE),
        "enumeration": _peer(enumerate_formulas(clean, peer_s), spec, planted_fspa),
    }
    if has_scarlet():
        record["scarlet"] = _peer(scarlet(clean, peer_s), spec, planted_fspa)
    return record


def _ours(evidence_: Evidence, planted_fspa: Fspa, min_support: float) -> Record:
    """Return the time from traces in memory to confirmed proposals, and the rank of the planted spec.

    The rank is None if no proposal is equivalent to the planted spec.
    """
    start = time.perf_counter()
    words = vocabulary_of_columns(dict.fromkeys(evidence_.atoms(), ColumnKind.TRUTHS))
    search = SpecSearch(evidence_, MiningOptions(min_support=min_support))
    for _ in search.run():
        pass
    proposals = confirm(search.ranking(), evidence_, words, CompileOptions(), _TOP)
    seconds = time.perf_counter() - start
    ranks = [rank for rank, proposal in enumerate(proposals, start=1) if _is_planted(proposal.fspa, planted_fspa)]
    return {"seconds": seconds, "rank": ranks[0] if ranks else None, "tried": search.tried_count}


def _is_planted(fspa: Fspa, planted_fspa: Fspa) -> bool:
    """Whether two automata accept the same traces; a mined one may remember what the planted one keeps in its state."""
    return compare(planted_fspa, fspa).relation == "equivalent"


def _peer(learned: LearnedFormula, spec: PlantedSpec, planted_fspa: Fspa) -> Record:
    equal = False
    if learned.formula is not None:
        signals = "".join(f"signal {atom}: bool\n" for atom in spec.probabilities)
        text = f"{signals}spec learned = {learned.formula}\n"
        equal = are_equivalent(compile_source(SourceFile("learned.tltl", text)).automata[0], planted_fspa)
    return {"seconds": learned.seconds, "formula": learned.formula, "equal": equal, "tried": learned.tried}


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Yield the rows of the table of goals, once all specs were measured."""
    if any("ours" not in records.get(name, {}) for name in SPECS):
        return
    first = sum(records[name]["ours"]["rank"] == 1 for name in SPECS)
    yield (
        f"the planted spec at rank 1, up to equivalence, for {_LEAST_FOUND} of {len(SPECS)} specs",
        f"{first} of {len(SPECS)}",
        met_or_missed(first >= _LEAST_FOUND),
    )
    ratios = {peer: _ratios(records, peer) for peer in PEERS}
    measured = {peer: peer_ratios for peer, peer_ratios in ratios.items() if peer_ratios}
    figure = "; ".join(
        f"{PEERS[peer]} {median(peer_ratios):.0f} times as long or longer" for peer, peer_ratios in measured.items()
    )
    met = all(median(peer_ratios) >= _FACTOR for peer_ratios in measured.values())
    yield "specs from traces in a tenth of the peers' time (median)", figure, met_or_missed(met)


def section(records: Mapping[str, Record]) -> str:
    """Return the section on specs from traces; empty without measurements."""
    measured = {name: records[name] for name in SPECS if "ours" in records.get(name, {})}
    if not measured:
        return ""
    rows = [_row(name, record) for name, record in measured.items()]
    limits = sorted({record["limit_s"] for record in measured.values() if "limit_s" in record})
    stopped = f"Both are stopped after {' or '.join(f'{limit:g}' for limit in limits)} s. " if limits else ""
    header = ("planted", "clauses", "ours, s", "rank", "with noise", *(f"{peer}, s" for peer in PEERS.values()))
    counts = "; ".join(
        f"{title} {sum(map(is_counted, measured.values()))} of {len(measured)}"
        for title, is_counted in (
            ("ours at rank 1", lambda record: record["ours"]["rank"] == 1),
            ("with noise", lambda record: record["noisy"]["rank"] == 1),
            *((title, lambda record, peer=peer: _is_equal(record, peer)) for peer, title in PEERS.items()),
        )
    )
    return f"""
## Specs from traces

`python -m benchmarks --only {SECTION}` plants the paper's three plans and {_RANDOM} random specs, over free atoms, in
{TRACES} traces that satisfy them and {COUNTEREXAMPLES} counterexamples (random walks on the automaton; half of the
counterexamples are near misses). Then the tools recover the specs. The traces have seed {_SEED}, and are the same in
each run; each time is that of one run. `mine` has templates for the kinds of the planted specs, but does not know
their atoms, lengths and noise. Enumeration can express all of the specs, Scarlet's fragment only those without an
until; both look for any formula that separates the traces. *Ours* is the wall time from letters in memory to the
{_TOP} best proposals, each compiled and judged by its automaton. *Rank* is the rank of the proposal that is
equivalent to the planted spec, and *with noise* the same if {NOISE:.0%} of the traces have changed sides. Enumeration
was written for this comparison, in Python with a bit per sample. It tries all formulas of `! & | X F G U` by size,
only one of those that agree on all samples, until one separates all traces. Scarlet (TACAS 2022) is the package from
PyPI; its time includes its process. {stopped}A peer's time has `=` if its formula is equivalent to the planted one,
`≠` if it only separates these traces, and `>` if the peer found none in that time.

Recovered: {counts}.

{table(header, rows)}
"""


def _row(name: str, record: Record) -> tuple[str, ...]:
    def rank(part: Mapping[str, Any]) -> str:
        return str(part["rank"] or "–")

    clauses = "; ".join(f"`{clause}`" for clause in record["clauses"])
    ours = record["ours"]
    peers = (_peer_cell(record[peer]) if peer in record else "–" for peer in PEERS)
    return (name, clauses, f"{ours['seconds']:.2f}", rank(ours), rank(record["noisy"]), *peers)


def _peer_cell(peer: Mapping[str, Any]) -> str:
    if peer["formula"] is None:
        return f"> {peer['seconds']:.1f}"
    return f"{peer['seconds']:.2f} {'=' if peer['equal'] else '≠'}"


def _is_equal(record: Record, peer: str) -> bool:
    return bool(record.get(peer, {}).get("equal"))


def _ratios(records: Mapping[str, Record], peer: str) -> list[float]:
    """Return for each spec the peer's time, or the time at which it was stopped, divided by ours."""
    return [
        records[name][peer]["seconds"] / records[name]["ours"]["seconds"] for name in SPECS if peer in records[name]
    ]
