"""Pictures of automata with registers: timers on states, guards in words, an arrow for each step of a trace."""

from __future__ import annotations

from random import Random

import pytest

from tltlc import backends, compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory_phrases import Speaker
from tltlc.backends.drawing import timed_guards
from tltlc.backends.drawing.folding import whole_drawing
from tltlc.backends.drawing.picture_content import PictureContent, picture_content
from tltlc.backends.drawing.state_rows import state_rows
from tltlc.interfaces.playground.picture import picture
from tltlc.logic.formula import Formula, atom
from tltlc.monitor.monitor import Monitor, Step

NAMES = "".join(f"signal {name}: bool\n" for name in ("alarm", "hidden", "a", "b", "seen", "safe"))
RULES = {
    "response": "keep alarm implies eventually within 5 s hidden",
    "within": "keep within 5 s of alarm, hidden",
    "strict": "keep alarm implies next eventually within 5 s (hidden and not a)",
    "chain": "reach a then within 5 s b",
    "stay": "reach always for 3 s safe",
    "stay_after": "reach a then (always for 3 s safe)",
    "later": "keep alarm implies weak_next eventually within 5 s hidden",
    "long_chain": "reach a then within 5 s b then within 5 s safe then within 3 s a then within 3 s hidden",
    "sequence": "avoid a and eventually within 5 s (b and eventually within 3 s safe)",
    "holding": "reach time_holding(safe) >= 3 s",
    "count": "keep times(seen) <= 3",
    "start": "require eventually within 5 s a",
    "rule": "keep begins alarm implies next always for 5 s (not hidden and not a)",
    "two": "keep alarm implies eventually within 5 s hidden  reach a then within 5 s b  keep times(seen) <= 3",
    "again": "keep eventually within 5 s a",
    "from_start": "require always for 5 s not a  require always for 3 s b",
}

CHAIN = "Either (reach a, then b within 5 s after a) or reach b within 5 s after a."
CLOCKS = ("32 Hz", "varies")
"""On the first clock, 5 s are 160 steps, and traces of 400 steps end late answers."""


def fspa_of(rule: str, clock: str = "60 Hz") -> Fspa:
    (fspa,) = compile_text(f"clock {clock}\n{NAMES}spec s {{ {RULES[rule]} }}")
    return fspa


def content_of(fspa: Fspa) -> PictureContent:
    return picture_content(fspa, whole_drawing(fspa), "unicode")


def next_step(monitor: Monitor, random: Random, share: float) -> Step:
    """Take a random sample, in which a signal holds with the probability ``share``."""
    fspa = monitor.fspa
    dt = random.choice((0.0, 1 / 32, 1 / 32, 1 / 16, 5.0)) if fspa.clock_varies else None
    return monitor.step({signal.name: float(random.random() < share) for signal in fspa.signals}, dt)


def rows_of(fspa: Fspa, state: int) -> tuple[str, ...]:
    return state_rows(fspa, (fspa.states[state],), content_of(fspa).timers.get(state, {}), "unicode")


@pytest.mark.parametrize(
    ("rule", "state", "rows"),
    [
        # Nothing is due in this state: no timer runs.
        ("response", 0, ("Always: hidden within 5 s after alarm",)),
        ("response", 1, ("◷ 5 s: hidden after alarm",)),
        ("within", 1, ("◷ 5 s: hidden after alarm",)),
        ("chain", 0, ("Reach a, then b within 5 s after a.",)),
        ("stay", 0, ("Reach either safe for 3 s or (safe at a step that is the last).", "◷ 3 s: safe without a break")),
        ("holding", 0, ("Reach safe for at least 3 s.", "◷ 3 s: safe without a break")),
        ("count", 0, ("Always: seen at most 3 times",)),
        ("start", 0, ("Reach a within 5 s.", "◷ 5 s: a")),
        ("two", 3, ("Always:", "hidden within 5 s after alarm", "seen at most 3 times")),
        ("two", 4, ("Always:", "◷ 5 s: hidden after alarm", "seen at most 3 times")),
        ("again", 1, ("◷ 5 s: a again",)),
        ("from_start", 0, ("Always:", "◷ 5 s: not a", "◷ 3 s: b")),
    ],
)
def test_a_state_shows_its_rules_and_the_timers_that_run_in_it(rule: str, state: int, rows: tuple[str, ...]) -> None:
    assert rows_of(fspa_of(rule), state) == rows


@pytest.mark.parametrize(
    ("rule", "state", "rows"),
    [
        ("response", 0, ("Always: hidden within 5 s after alarm",)),
        ("response", 1, ("◷ 5 s: hidden after alarm",)),
        (
            "chain",
            1,
            ("Either (reach a, then b within 5 s after a) or reach b within 5 s after a.", "◷ 5 s: b after a"),
        ),
        ("stay", 1, ("Reach either safe for 3 s or (safe at a step that is the last).", "◷ 3 s: safe without a break")),
        ("start", 0, ("Reach a within 5 s.", "◷ 5 s: a")),
        ("again", 1, ("◷ 5 s: a again",)),
        ("from_start", 0, ("Always:", "◷ 5 s: not a", "◷ 3 s: b")),
    ],
)
def test_a_state_shows_its_timers_on_a_clock_that_varies(rule: str, state: int, rows: tuple[str, ...]) -> None:
    assert rows_of(fspa_of(rule, "varies"), state) == rows


def test_rules_about_one_sample_are_in_words_and_have_no_clock() -> None:
    rules = " ".join(f"keep a{n} implies b{n} or c{n}" for n in range(12))
    signals = "".join(f"signal {letter}{n}: bool\n" for letter in "abc" for n in range(12))
    (fspa,) = compile_text(f"clock 60 Hz\n{NAMES}{signals}spec s {{ {RULES['response']} {rules} }}")
    *rules_shown, last = rows_of(fspa, 1)
    assert rules_shown[:3] == ["Always:", "◷ 5 s: hidden after alarm", "a0 implies (b0 or c0)"]
    assert last == "and 5 more rules"
    broken = [f"a{n} and not b{n} and not c{n}" for n in range(12)]
    assert sorted(content_of(fspa).guards[1, 2]) == sorted(["hidden later than 5 s after alarm", *broken])


@pytest.mark.parametrize(
    ("rule", "arrow", "guard"),
    [
        ("response", (1, 2), ["hidden later than 5 s after alarm"]),
        ("response", (1, 0), ["hidden is not due after alarm"]),
        ("response", (0, 1), ["hidden is due after alarm"]),
        ("chain", (1, 1), ["a", "less than 5 s have passed since a"]),
        ("chain", (1, 0), ["not a and 5 s have passed since a"]),
        ("stay", (0, 2), ["safe for 3 s"]),
        ("count", (0, 1), ["seen more than 3 times"]),
        ("start", (0, 0), ["otherwise"]),
        ("rule", (1, 1), ["alarm does not begin"]),
        ("two", (4, 2), ["hidden later than 5 s after alarm", "seen more than 3 times"]),
        ("rule", (1, 2), ["(hidden or a) within the next 5 s after alarm begins"]),
    ],
)
def test_guards_are_in_words(rule: str, arrow: tuple[int, int], guard: list[str]) -> None:
    assert content_of(fspa_of(rule)).guards[arrow] == guard


def test_an_arrow_that_no_trace_can_take_is_not_drawn() -> None:
    fspa = fspa_of("response")
    assert any((edge.source, edge.target) == (0, 2) for edge in fspa.edges)
    assert (0, 2) not in content_of(fspa).guards


@pytest.mark.parametrize("clock", CLOCKS)
@pytest.mark.parametrize("rule", RULES)
def test_every_step_of_a_trace_has_an_arrow(rule: str, clock: str) -> None:
    fspa, random = fspa_of(rule, clock), Random(rule)
    assert fspa.registers
    guards = content_of(fspa).guards
    taken: set[tuple[int, int]] = set()
    for _ in range(20):
        monitor, state = Monitor(fspa), 0
        share = random.choice((0.002, 0.01, 0.1, 0.5, 0.98))
        for _ in range(500):
            step = next_step(monitor, random, share)
            taken.add((state, step.state))
            state = step.state
    assert taken <= guards.keys()
    assert len(taken) > 1


def holds(formula: Formula, atoms: dict[str, bool]) -> bool:
    if formula.op == "atom":
        return atoms[formula.name]
    parts = [holds(part, atoms) for part in formula.args]
    return not parts[0] if formula.op == "not" else all(parts) if formula.op in ("and", "true") else any(parts)


@pytest.mark.parametrize("clock", CLOCKS)
@pytest.mark.parametrize("rule", RULES)
def test_the_guards_of_a_picture_tell_the_next_state(rule: str, clock: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the arrows whose guards hold, one to a final state comes first; "otherwise" is the last."""
    monkeypatch.setattr(Speaker, "spoken", lambda _, formula: formula)
    fspa, random = fspa_of(rule, clock), Random(rule)
    drawing = timed_guards.timed_drawing(fspa, whole_drawing(fspa)).drawing
    final = [state.id for state in fspa.states if state.verdict in ("satisfied", "violated")]
    for _ in range(10):
        monitor, state = Monitor(fspa), 0
        share = random.choice((0.002, 0.01, 0.1, 0.5, 0.98))
        for _ in range(400):
            step = next_step(monitor, random, share)
            atoms = {each.name: value > 0 for each, value in zip(fspa.atoms, monitor.values, strict=True)}
            atoms |= {timed_guards.ALWAYS: True, timed_guards.OTHERWISE: True}
            guards = [(edge.target, edge.label.guard.formula) for edge in drawing.edges if edge.source == state]
            true = [
                (formula is atom(timed_guards.OTHERWISE), target not in final, target)
                for target, formula in guards
                if isinstance(formula, Formula) and holds(formula, atoms)
            ]
            assert min(true)[2] == step.state
            assert len({target for otherwise, _, target in true if not otherwise and target not in final}) <= 1
            state = step.state


def test_the_legend_has_the_registers_with_units() -> None:
    rows = [(row.name, row.kind, row.maximum, row.initial) for row in content_of(fspa_of("two")).memory]
    assert rows == [
        ("hidden after alarm", "longest wait", "10 s", "0 s"),
        ("a", "time since", "9.98 s", "9.98 s"),
        ("times(seen)", "count", "7", "0"),
    ]


@pytest.mark.parametrize("target", ["dot", "mermaid", "svg"])
def test_pictures_show_the_clock_the_words_and_the_legend(target: str) -> None:
    (text,) = backends.emit(target, fspa_of("response")).values()
    shown = (text.decode() if isinstance(text, bytes) else text).replace("<br/>", " ").replace("<BR/>", " ")
    for words in ("◷ 5 s", "hidden is due after", "longest wait", "10 s"):
        assert words in shown
    assert "late(5 s" not in shown


def test_the_playground_shows_the_same() -> None:
    svg, note = picture(fspa_of("response"))
    assert svg is not None
    assert "◷ 5 s" in svg
    assert "late(5 s" not in svg
    assert "Memory: hidden after alarm: longest wait, at most 10 s, 0 s at the start." in note
