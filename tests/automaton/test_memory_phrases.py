"""What atoms remember, in words: the words come from the kinds of registers, and never change what is meant."""

from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory_phrases import spoken
from tltlc.automaton.text import formula_text, label_range_text, label_text
from tltlc.backends import emit
from tltlc.core.source import SourceFile
from tltlc.logic.formula import Formula, atom, not_
from tltlc.logic.text.printer import english_text
from tltlc.pipeline import read_artefact

NAMES = (
    "clock 10 Hz\nentity e\nsignal seen: bool\nsignal alarm: bool\nsignal near(x: entity): bool\nsignal hp in [0, 9]\n"
)


def _fspa(clause: str) -> Fspa:
    (fspa,) = compile_text(f"{NAMES}spec s {{ {clause} }}")
    return fspa


@pytest.mark.parametrize(
    ("clause", "english"),
    [
        ("keep times(seen) <= 3", "Keep seen at most 3 times throughout."),
        ("avoid times(near(e)) >= 2", "Avoid near(e) at least twice throughout."),
        ("reach time_holding(near(e)) >= 3 s", "Reach near(e) for at least 3 s."),
        (
            "keep time_since(alarm) < 5 s implies not seen",
            "Whenever less than 5 s after alarm, avoid seen at that step.",
        ),
        ("keep once within 5 s alarm implies seen", "Whenever alarm in the last 5 s, have seen at that step."),
        (
            "keep seen implies historically for 20 steps alarm",
            "Whenever seen, have had alarm for the last 2 s.",
        ),
        ("keep begins seen implies alarm", "Whenever seen begins, have alarm at that step."),
        ("reach ends near(e) and alarm", "Reach near(e) ends and alarm."),
        ("reach once seen", "Reach seen now or before."),
        ("keep times(seen and alarm) <= 3", "Keep (seen and alarm) at most 3 times throughout."),
        ("keep times(not seen) <= 3", "Keep not seen at most 3 times throughout."),
        ("keep hp >= previous(hp)", "Keep hp >= the previous hp throughout."),
        # These keep their names, with conditions in words: they are sums.
        ("keep times(seen, 9) + times(alarm, 9) <= 3", "Keep times(seen, 9) + times(alarm, 9) <= 3 throughout."),
        (
            "keep times(not seen, 9) + times(hp > 3 and not alarm, 9) <= 3",
            "Keep times(not seen, 9) + times(hp > 3 and not alarm, 9) <= 3 throughout.",
        ),
        (
            "keep abs(hp - value_at(hp, not seen)) <= 3",
            "Keep abs(hp - value_at(hp, not seen)) <= 3 throughout.",
        ),
        (
            "keep times_since(not seen, begins alarm, 9) <= hp",
            "Keep times_since(not seen, begins alarm, 9) <= hp throughout.",
        ),
        (
            "keep begins (not seen or alarm) implies hp > 3",
            "Whenever (not seen or alarm) begins, have hp > 3 at that step.",
        ),
    ],
)
def test_formulas_with_memory_read_well(clause: str, english: str) -> None:
    fspa = _fspa(clause)
    assert formula_text(fspa) == english
    (text,) = emit("json", fspa).values()
    assert formula_text(read_artefact(SourceFile("s.fspa.json", str(text)))) == english


def test_labels_use_the_same_words_and_other_notations_the_names() -> None:
    fspa = _fspa("reach seen then time_holding(near(e)) >= 3 s")
    assert label_text(fspa, 1) == "Reach near(e) for at least 3 s."
    assert label_text(fspa, 1, "ascii") == "F !(time_holding(near(e)) < 3)"


@pytest.mark.parametrize(
    ("event", "words"),
    [
        ("begins (time_holding(not seen) >= 3 s)", "(not seen for at least 3 s) begins"),
        ("begins (not seen and hp > 3)", "(not seen and hp > 3) begins"),
        ("ends (not seen and hp > 3)", "(not seen and hp > 3) ends"),
        ("begins (not seen or hp > 3)", "(not seen or hp > 3) begins"),
    ],
)
def test_labels_say_what_begins_and_ends(event: str, words: str) -> None:
    fspa = _fspa(f"keep {event} implies eventually within 5 steps alarm")
    assert label_text(fspa, 0).startswith(f"Whenever {words}, reach alarm within")


def test_the_labels_of_states_that_share_a_row_are_in_words() -> None:
    fspa = _fspa("keep time_holding(not seen) >= 3 s and hp > 3 implies eventually within 5 steps alarm")
    rule = "Whenever not seen for at least 3 s and hp > 3, reach alarm within 5 steps"
    assert label_range_text(fspa, 2, 3) == f"{rule}; and reach alarm within 3…2 steps."


def test_labels_list_the_rules_one_by_one() -> None:
    rules = "keep within 5 s of alarm, seen  keep begins seen implies next always for 9 s not near(e)"
    fspa = _fspa(f"{rules}  keep times(seen) <= 3")
    assert {label_text(fspa, state.id) for state in fspa.states if state.verdict != "violated"} == {
        "Whenever alarm, reach seen within 5 s; whenever seen begins, avoid near(e) for the next 9 s; "
        "whenever seen begins, the play must not end at that step; and keep seen at most 3 times throughout."
    }


GAME = """
clock 10 Hz
signal seen: bool
signal hidden: bool
signal alarm: bool
signal damage: bool
signal boss_door: bool
signal double_jump: bool
entity door, key, vault
entity g1, g2
entity guards = g1, g2
signal near(x: entity): bool
signal has(x: entity): bool
signal answers(x: entity): bool
signal health: int in [0, 10]
signal phase: int in [0, 5]
signal mode(g: entity): (idle, alert, chase)
signal coins in [0, 100]
signal distance(x: entity): length in [0 m, 50 m]
"""
SENTENCES = [
    ("keep within 5 s of alarm, hidden", "Whenever alarm, reach hidden within 5 s."),
    ("keep eventually within 30 s hidden", "At every step, reach hidden within 30 s."),
    ("keep within 60 s of alarm, hidden", "Whenever alarm, reach hidden within 60 s."),
    ("keep near(vault) implies once has(key)", "Whenever near(vault), have has(key) now or before."),
    ("keep times(seen and not hidden) <= 3", "Keep (seen and not hidden) at most 3 times throughout."),
    ("reach times(seen or alarm) >= 2", "Reach (seen or alarm) at least twice."),
    ("reach times(seen) == 3", "Reach seen exactly 3 times."),
    ("keep times(seen) != 2", "Keep seen not exactly twice throughout."),
    ("keep times(seen) == 0", "Keep seen 0 times so far throughout."),
    ("keep once within 5 s alarm implies hidden", "Whenever alarm in the last 5 s, have hidden at that step."),
    (
        "keep once within 5 s (alarm and seen) implies hidden",
        "Whenever (alarm and seen) in the last 5 s, have hidden at that step.",
    ),
    ("keep coins >= previous(coins)", "Keep coins >= the previous coins throughout."),
    ("reach time_holding(near(vault) and not seen) >= 3 s", "Reach (near(vault) and not seen) for at least 3 s."),
    (
        "keep begins damage implies weak_next always for 10 s not damage",
        "Whenever damage begins, avoid damage for the next 10 s.",
    ),
    (
        "keep begins damage implies next always for 10 s not begins damage",
        "Whenever damage begins, avoid the start of damage for the next 10 s; "
        "and whenever damage begins, the play must not end at that step.",
    ),
    (
        "keep alarm implies all g in guards: eventually within 50 s answers(g)",
        "Whenever alarm, reach answers(g1) within 50 s; and whenever alarm, reach answers(g2) within 50 s.",
    ),
    ("keep alarm implies always for 20 s not seen", "Whenever alarm, avoid seen for 20 s."),
    (
        "keep all g in guards: mode(g) is not chase",
        "Avoid mode(g1) is chase throughout, and avoid mode(g2) is chase throughout.",
    ),
    (
        "keep mode(g1) is chase implies eventually within 20 s mode(g1) is idle",
        "Whenever mode(g1) is chase, reach mode(g1) is idle within 20 s.",
    ),
    (
        "reach phase == 1 then phase == 2 then within 30 s phase == 3",
        "Reach phase == 1, then phase == 2, then phase == 3 within 30 s after phase == 2.",
    ),
    (
        "keep previous(phase) == 3 implies phase != 0",
        "Whenever the previous phase == 3, avoid phase == 0 at that step.",
    ),
    ("keep historically for 3 s hidden implies not seen", "Whenever hidden for the last 3 s, avoid seen at that step."),
    ("reach near(key) then within 20 s near(door)", "Reach near(key), then near(door) within 20 s after near(key)."),
    (
        "reach alarm then within 20 s seen then within 30 s hidden then within 40 s near(door)",
        "Reach alarm, then seen within 20 s after alarm, then hidden within 30 s after seen, "
        "then near(door) within 40 s after hidden.",
    ),
    ("require always for 20 s hidden", "Keep hidden for 20 s."),
    ("require always for 20 s not hidden", "Avoid hidden for 20 s."),
    ("require not (always for 20 s hidden)", "Reach not hidden within 20 s."),
    ("require not (always for 20 s not hidden)", "Reach hidden within 20 s."),
    ("require not (eventually within 20 s hidden)", "Avoid hidden for 20 s."),
    ("require not (eventually within 20 s not hidden)", "Keep hidden for 20 s."),
    (
        "require not (always for 20 s hidden) or eventually within 30 s near(door)",
        "Either reach not hidden within 20 s or reach near(door) within 30 s.",
    ),
    (
        "require (eventually within 20 s hidden) implies eventually seen",
        "Either avoid hidden for 20 s or reach seen.",
    ),
    ("keep not historically for 3 s hidden", "Have a step with not hidden in the last 3 s throughout."),
    (
        "avoid alarm and eventually within 20 s (seen and eventually within 10 s hidden)",
        "Avoid (hidden and seen within 20 s of alarm in the last 10 s) throughout.",
    ),
    ("reach previously once alarm and hidden", "Reach alarm at an earlier step and hidden."),
    ("require eventually within 30 s near(door)", "Reach near(door) within 30 s."),
    ("keep time_since(alarm) >= 5 s or hidden", "Keep at least 5 s after alarm or hidden throughout."),
    ("keep time_since(alarm) < 5 s implies hidden", "Whenever less than 5 s after alarm, have hidden at that step."),
    ("keep time_since(not hidden) > 2 s", "Be more than 2 s after not hidden throughout."),
    ("keep ends alarm implies hidden", "Whenever alarm ends, have hidden at that step."),
    ("keep hidden since alarm", "Keep hidden since alarm throughout."),
    ("keep alarm implies hidden since seen", "Whenever alarm, have hidden since seen."),
    ("keep previously alarm implies hidden", "Whenever alarm at the step before, have hidden at that step."),
    (
        "keep previously (alarm and seen) implies hidden",
        "Whenever (alarm and seen) at the step before, have hidden at that step.",
    ),
    (
        "keep previously (mode(g2) is alert) implies hidden",
        "Whenever mode(g2) was alert at the step before, have hidden at that step.",
    ),
    ("avoid previously (mode(g2) is alert)", "Keep mode(g2) was not alert at the step before throughout."),
    (
        "keep previously (mode(g2) is not alert) implies hidden",
        "Whenever mode(g2) was not alert at the step before, have hidden at that step.",
    ),
    ("keep begins (alarm and seen) implies hidden", "Whenever (alarm and seen) begins, have hidden at that step."),
    ("keep historically (alarm implies hidden)", "Keep (alarm implies hidden) all along throughout."),
    ("keep near(door) implies times(has(key)) >= 1", "Whenever near(door), have had has(key) at least once."),
    ("keep alarm implies next eventually within 20 s hidden", "Whenever alarm, reach hidden within the next 20.1 s."),
    ("keep initial(coins) <= coins", "Keep coins >= the initial coins throughout."),
    ("keep seen implies time_holding(alarm) < 3 s", "Whenever seen, have had alarm for less than 3 s."),
    ("keep seen implies not once within 20 steps alarm", "Whenever seen, avoid alarm in the last 2 s."),
    ("keep seen implies once within 1 s alarm", "Whenever seen, have had alarm in the last 1 s."),
    (
        "keep begins seen implies weak_next always for 10 s not begins seen",
        "Whenever seen begins, avoid the start of seen for the next 10 s.",
    ),
    (
        "reach begins seen then within 10 s begins seen",
        "Reach seen begins, then the start of seen within 10 s after seen begins.",
    ),
    ("require once alarm until seen", "Reach seen, keeping alarm now or before until then."),
    (
        "keep alarm and times(seen) < 3 implies hidden or mode(g2) is alert",
        "Whenever alarm and seen less than 3 times, have hidden or mode(g2) is alert at that step.",
    ),
]
"""Specs with memory, deadlines, counts, windows and enums, each with its sentence."""


@pytest.mark.parametrize(("clause", "english"), SENTENCES)
def test_a_designer_can_read_the_sentence(clause: str, english: str) -> None:
    (fspa,) = compile_text(f"{GAME}spec s {{ {clause} }}")
    assert formula_text(fspa) == english
    (text,) = emit("json", fspa).values()
    assert formula_text(read_artefact(SourceFile("s.fspa.json", str(text)))) == english


def test_times_are_in_seconds_where_these_are_whole_or_half_ones() -> None:
    text = "signal seen: bool\nspec s = F[0,{}] seen"
    sentences = []
    for clock in ("", "clock 10 Hz\n", "clock 60 Hz\n"):
        for steps in (3, 5, 30):
            (fspa,) = compile_text(clock + text.format(steps))
            sentences.append(formula_text(fspa).removeprefix("Reach seen within "))
    assert sentences == [
        "3 steps.",
        "5 steps.",
        "30 steps.",
        "3 steps.",
        "0.5 s.",
        "3 s.",
        "3 steps.",
        "5 steps.",
        "0.5 s.",
    ]


@pytest.mark.parametrize(
    ("clause", "guard", "words"),
    [
        (
            "keep begins seen implies next always for 20 s (not alarm and not near(e))",
            (0, 2),
            "(alarm or near(e)) within the next 20 s after seen begins",
        ),
        ("require always for 20 s not alarm  require always for 10 s seen", (0, 1), "alarm in the first 20 s"),
        ("keep begins seen implies next always for 20 s not alarm", (0, 1), "seen does not begin"),
    ],
)
def test_guards_say_what_breaks_a_rule(clause: str, guard: tuple[int, int], words: str) -> None:
    fspa = _fspa(clause)
    (formula,) = (edge.guard.formula for edge in fspa.edges if (edge.source, edge.target) == guard)
    assert isinstance(formula, Formula)
    assert words in english_text(spoken(formula, fspa))


@pytest.mark.parametrize("clock", ["60 Hz", "varies"])
@pytest.mark.parametrize(
    ("clause", "english", "breaks"),
    [
        ("keep always for 2 s q", "Keep q throughout.", "!q"),
        ("keep always for 2 s not q", "Avoid q throughout.", "q"),
        ("keep always for 2 s (p implies q)", "Whenever p, have q at that step.", "p & !q"),
        ("keep true implies always for 2 s (p or q)", "Keep p or q throughout.", "!p & !q"),
        ("avoid eventually within 2 s p", "Avoid p throughout.", "p"),
    ],
)
def test_a_time_since_every_step_is_left_out(clock: str, clause: str, english: str, breaks: str) -> None:
    (fspa,) = compile_text(f"clock {clock}\nsignal p: bool\nsignal q: bool\nspec s {{ {clause} }}")
    violated = next(state.id for state in fspa.states if state.verdict == "violated")
    guard = next(edge.guard.formula for edge in fspa.edges if (edge.source, edge.target) == (0, violated))
    assert isinstance(guard, Formula)
    assert formula_text(fspa) == label_text(fspa, 0) == english
    assert str(spoken(guard, fspa)) == breaks


@pytest.mark.parametrize(
    ("clock", "clause", "english"),
    [
        ("60 Hz", "reach true then within 2 s q", "At the next step, reach q at that step or later."),
        ("60 Hz", "avoid (true then within 2 s q)", "Avoid (q and any step in the 2 s before) throughout."),
        ("varies", "avoid (true then within 2 s q)", "Avoid (q and any step in the 2 s before) throughout."),
        (
            "60 Hz",
            "keep true implies weak_next always for 2 s q",
            "Keep q for the next 2 s after any step throughout.",
        ),
        ("varies", "keep once within 2 s true implies q", "Whenever any step in the last 2 s, have q at that step."),
    ],
)
def test_an_event_at_every_step_has_words(clock: str, clause: str, english: str) -> None:
    (fspa,) = compile_text(f"clock {clock}\nsignal p: bool\nsignal q: bool\nspec s {{ {clause} }}")
    assert formula_text(fspa) == english


def test_a_timer_of_the_steps_before_has_words_where_it_fails() -> None:
    (fspa,) = compile_text("clock varies\nsignal q: bool\nspec s { reach true then within 2 s q }")
    recent = atom("recent(2 s, true)")
    assert str(spoken(recent, fspa)) == "any step in the 2 s before"
    assert str(spoken(not_(recent), fspa)) == "no step in the 2 s before"


@pytest.mark.parametrize(
    ("clauses", "english"),
    [
        ("reach calm", "Reach calm."),
        ("reach lately(g1) avoid seen", "Reach lately(g1), and avoid seen throughout."),
        ("require (not passed(g1)) until seen", "Reach seen, avoiding passed(g1) until then."),
        ("keep seen implies eventually held(g1)", "Whenever seen, reach held(g1) at that step or later."),
        ("reach chain(g1, g2)", "Reach chain(g1, g2)."),
    ],
)
def test_a_predicate_that_reads_a_time_or_has_the_name_of_a_timer_keeps_its_name(clauses: str, english: str) -> None:
    (fspa,) = compile_text(f"{GAME}{PREDICATES}spec s {{ {clauses} }}")
    assert formula_text(fspa) == english
    for target in ("dot", "mermaid", "json"):
        (text,) = emit(target, fspa).values()
        assert "◷" not in str(text)


PREDICATES = """
predicate calm in [-1, 1] = (time_since(seen, 10 s) - 5 s) / 5 s
predicate lately(x: entity) in [-1, 1] = clamp((time_since(near(x), 4 s) - 2 s) / 2 s, -1, 1)
predicate passed(x: entity) in [-1, 1] = clamp((time_since(near(x), 4 s) - 2 s) / 2 s, -1, 1)
predicate held(x: entity) in [-1, 1] = clamp((time_holding(near(x), 4 s) - 2 s) / 2 s, -1, 1)
predicate chain(x: entity, y: entity) in [-1, 1] = clamp(previous(health) / 10, -1, 1)
"""


@pytest.mark.parametrize(
    ("outside", "inside"),
    [
        ("not previously seen", "previously not seen"),
        ("not once seen", "once not seen"),
        ("not (seen since alarm)", "(not seen) since alarm"),
        ("not once within 5 s seen", "once within 5 s not seen"),
        ("not historically for 5 s seen", "historically for 5 s not seen"),
        ("not (time_holding(seen) >= 2 s)", "time_holding(not seen) >= 2 s"),
        ("times(once within 5 s seen) <= 2", "times(seen) <= 2 and once within 5 s seen"),
        ("not (always for 20 s seen)", "always for 20 s not seen"),
        ("not (eventually within 20 s seen)", "eventually within 20 s not seen"),
    ],
)
def test_a_negation_outside_and_one_inside_read_differently(outside: str, inside: str) -> None:
    texts = set()
    for formula in (outside, inside):
        (fspa,) = compile_text(f"{GAME}spec s {{ require {formula} }}")
        texts.add(formula_text(fspa))
    assert len(texts) == 2


def test_negated_times_read_alike_on_a_clock_that_varies() -> None:
    for formula, english in (
        ("not (always for 20 s seen)", "Reach not seen within 20 s."),
        ("not (eventually within 20 s seen)", "Avoid seen for 20 s."),
        ("(always for 20 s seen) implies eventually alarm", "Either reach not seen within 20 s or reach alarm."),
    ):
        (fspa,) = compile_text(f"{GAME.replace('10 Hz', 'varies')}spec s {{ require {formula} }}")
        assert formula_text(fspa) == english
