"""One atom for each rule about single samples: the language, verdicts and robustness stay, and guards are small."""

from __future__ import annotations

import random

import pytest

from tests.resolve.helpers import valid_program
from tltlc.automaton.finite.build import build
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import formula_text
from tltlc.backends import emit
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text
from tltlc.resolve import breaches
from tltlc.tools.explain.explanation import explain
from tltlc.tools.judge.clauses import clauses_of
from tltlc.tools.judge.judge import Judge

NAMES = ("a", "b", "c", "d", "e")
BOOLS = "".join(f"signal {name}: bool\n" for name in NAMES)
MEMORY = "keep a implies eventually within 90 steps b"


def both(text: str, monkeypatch: pytest.MonkeyPatch) -> tuple[Fspa, Fspa]:
    """Return the automaton with guards over all atoms, and the one with an atom for each rule."""
    automata = []
    for most in (10**9, 0):
        monkeypatch.setattr(breaches, "MOST_PRODUCTS", most)
        automata.append(compile_text(text)[0])
    return automata[0], automata[1]


def random_state(generator: random.Random, depth: int) -> str:
    if depth == 0 or generator.random() < 0.2:
        return generator.choice((*NAMES, "once c", "previously d"))
    if generator.random() < 0.25:
        return f"(not {random_state(generator, depth - 1)})"
    operator = generator.choice(("and", "or", "implies", "iff"))
    return f"({random_state(generator, depth - 1)} {operator} {random_state(generator, depth - 1)})"


def test_atoms_for_rules_keep_the_language_and_no_verdict_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    generator = random.Random(7)
    replaced = 0
    for _ in range(60):
        rules = [f"keep {random_state(generator, 3)}" for _ in range(generator.randint(1, 4))]
        goal = generator.choice(("", "reach e", "reach a then d"))
        groups = generator.choice(("", "exclusive c, d\n"))
        text = f"{BOOLS}{groups}spec s {{ {MEMORY} {goal} {' '.join(rules)} }}"
        plain, short = both(text, monkeypatch)
        replaced += plain != short
        for _ in range(15):
            monitors = Monitor(plain), Monitor(short)
            for _ in range(10):
                sample = {name: generator.random() < 0.5 for name in NAMES}
                sample["d"] = sample["d"] and not (groups and sample["c"])
                expected, step = (monitor.step(sample) for monitor in monitors)
                assert step.accepting == expected.accepting, text
                undecided = "holding" if step.accepting else "pending"
                assert step.verdict in (expected.verdict, undecided), text
    assert replaced > 40


def test_rules_about_different_atoms_keep_robustness_progress_and_verdicts(monkeypatch: pytest.MonkeyPatch) -> None:
    signals = "".join(f"signal x{number}: number in [-1, 1]\n" for number in range(9))
    rules = " ".join(
        (
            "keep x1 > 0 implies x2 > 0 or x3 > 0",
            "avoid x4 > 0 and (x5 > 0 or not (x6 > 0))",
            "keep (x7 > 0 or x8 > 0) and x0 < 0.99",
        )
    )
    text = f"{signals}spec s {{ reach x0 > 0.9 keep x0 > -0.9 implies eventually within 90 steps x0 > 0 {rules} }}"
    plain, short = both(text, monkeypatch)
    generator = random.Random(3)
    for _ in range(300):
        monitors = Monitor(plain), Monitor(short)
        for _ in range(6):
            sample = {f"x{number}": generator.choice((0.0, generator.uniform(-1, 1))) for number in range(9)}
            expected, step = (monitor.step(sample) for monitor in monitors)
            assert step.verdict == expected.verdict
            # A negation has the robustness 1e-30 where that of its operand is 0.
            assert step.robustness == pytest.approx(expected.robustness, abs=1e-29)
            assert step.progress == pytest.approx(expected.progress, abs=1e-29)
            assert step.reward == pytest.approx(expected.reward, abs=1e-29)


def many_rules(count: int, memory: str = MEMORY) -> str:
    signals = "".join(f"signal {name}{number}: bool\n" for number in range(count) for name in "pqr")
    rules = "".join(f"keep p{number} implies q{number} or r{number}\n" for number in range(count))
    return f"{BOOLS}{signals}spec s {{ {memory} {rules} }}"


def test_many_rules_have_guards_and_monitors_in_proportion_to_their_number() -> None:
    sizes = {}
    for count in (10, 20, 40):
        (fspa,) = compile_text(many_rules(count))
        assert len(fspa.states) == 3
        assert sum(len(edge.guard.primes) for edge in fspa.edges) <= 2 * count + 10
        sizes[count] = [sum(map(len, emit(target, fspa).values())) for target in ("c", "json", "lua")]
    for small, middle, large in zip(*sizes.values(), strict=True):
        assert large - middle < 2.5 * (middle - small)


def test_few_rules_and_specs_without_memory_keep_their_guards() -> None:
    (few,) = compile_text(many_rules(2))
    (none,) = compile_text(many_rules(5, "keep a or b"))
    assert "breach" not in {register.kind for register in few.registers}
    assert not none.registers


def test_rules_in_words_are_those_of_the_text(monkeypatch: pytest.MonkeyPatch) -> None:
    rules = {
        "keep c implies d or not e": "whenever c, have d or not e at that step",
        "avoid c and d": "avoid (c and d) throughout",
        "keep c or d": "keep c or d throughout",
        "keep (c and not d) or e": "keep ((c and not d) or e) throughout",
        "keep c implies (d implies not e)": "avoid (c and d and e) throughout",
    }
    for rule, words in rules.items():
        plain, short = both(f"{BOOLS}spec s {{ {MEMORY} {rule} }}", monkeypatch)
        assert plain != short
        assert words in formula_text(short), rule
    text = f"{BOOLS}spec s {{ {MEMORY} keep c implies d or not e }}"
    before, after = map(explain, both(text, monkeypatch))
    assert [failure.when for failure in before.failures] == [failure.when for failure in after.failures]
    assert before.memory == after.memory


def test_a_broken_rule_is_named_with_the_atoms_that_break_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(breaches, "MOST_PRODUCTS", 0)
    spec = valid_program(f"{BOOLS}spec s {{ {MEMORY} keep c implies d or not e keep d or a }}").specs[0]
    fspa = build(spec)
    sample = dict.fromkeys(NAMES, False)
    cause = Judge(fspa, clauses_of(fspa, spec)).verdict([{**sample, "a": True, "c": True, "e": True}]).cause
    assert cause is not None
    assert cause.clauses == ("keep c implies d or not e",)
    assert set(cause.atoms) == {"c", "d", "e"}
