"""Which clauses a trace has not met in the end."""

from __future__ import annotations

from itertools import product

from tltlc.core.source import SourceFile
from tltlc.monitor import Monitor
from tltlc.pipeline import Session
from tltlc.tools.judge.clauses import clauses_of
from tltlc.tools.judge.open_clauses import open_clauses

CLAUSES = (
    "reach a then b",
    "keep a implies eventually b",
    "reach times(a) >= 2 and b",
    "avoid b and not once a",
    "keep begins b implies eventually within 2 s not b",
)
TEXT = "clock 1 Hz\nsignal a: bool\nsignal b: bool\nspec s {\n" + "\n".join(CLAUSES) + "\n}\n"


def _session(text: str) -> Session:
    return Session(SourceFile("s.tltl", text))


def test_a_clause_is_open_if_a_spec_of_it_alone_is_pending() -> None:
    session = _session(TEXT)
    clauses = clauses_of(session.automata[0], session.specs[0])
    alone = [_session(f"clock 1 Hz\nsignal a: bool\nsignal b: bool\nspec s {{\n{clause}\n}}\n") for clause in CLAUSES]
    for trace in product(product((0.0, 1.0), repeat=2), repeat=4):
        samples = [{"a": a, "b": b} for a, b in trace]
        opened = [item.clause for item in open_clauses(clauses, CLAUSES, samples)]
        verdicts = [_verdict(session, samples) for session in alone]
        assert opened == [index for index, verdict in enumerate(verdicts) if verdict == "pending"]


def _verdict(session: Session, samples: list[dict[str, float]]) -> str:
    monitor = Monitor(session.automata[0])
    return [monitor.step(sample).verdict for sample in samples][-1]


def test_the_atoms_are_those_that_decide_the_next_step() -> None:
    session = _session(TEXT)
    clauses = clauses_of(session.automata[0], session.specs[0])
    opened = open_clauses(clauses, CLAUSES, [{"a": 1.0, "b": 0.0}, {"a": 0.0, "b": 0.0}])
    atoms = {CLAUSES[item.clause]: item.atoms for item in opened}
    assert atoms["reach a then b"] == {"b"}
    assert atoms["reach times(a) >= 2 and b"] == {"times(a) < 2", "b"}


def test_a_clause_that_one_more_step_would_meet_needs_a_step() -> None:
    session = _session(TEXT)
    clauses = clauses_of(session.automata[0], session.specs[0])
    opened = {
        item.clause: item for item in open_clauses(clauses, CLAUSES, [{"a": 0.0, "b": 0.0}, {"a": 1.0, "b": 1.0}])
    }
    assert opened[0].needs_step and not opened[2].needs_step
