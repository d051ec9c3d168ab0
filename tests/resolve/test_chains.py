"""Long chains of goals in time: one atom has their language, their verdicts and an honest progress."""

from __future__ import annotations

import json
import random
from collections.abc import Sequence

import pytest

from tests.resolve.helpers import only_spec
from tests.resolve.test_deadlines import RULES, agree_on_random_formulas, compiled, random_trace, steps
from tltlc.automaton.finite.build import build
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import formula_text
from tltlc.backends import emit
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text, decode_artefact, encode_artefact
from tltlc.resolve import chains
from tltlc.resolve.spec import Timer
from tltlc.tools.explain.explanation import explain

CHAINS = (
    "reach a then within {n} steps b",
    "reach a then within {n} steps b then within {m} steps c",
    "reach a then within {n} steps b then within {m} steps a then within {m} steps c",
    "reach a then within {n} steps (b and not c) then c then within {m} steps a",
    "reach a then b then within {n} steps c then within {m} steps a",
    "reach a then b then c then within {n} steps a then within {m} steps b",
    "reach a then within {n} steps b then within {m} steps c then b",
    "require eventually (a and eventually within {n} steps (b and next eventually within {m} steps c))",
    "require eventually (a and eventually (b and eventually within {n} steps (c and not a)))",
    "require eventually within {n} steps (a and next F[0,{m}] (b and eventually within {m} steps c))",
    "require F[2,{n}] (a and next eventually within {m} steps (b and next eventually c))",
    "require eventually within {n} steps (a and next eventually (b and next eventually within {m} steps c))",
    "require not eventually (a and next eventually within {n} steps (b and next eventually within {m} steps c))",
    "avoid a then within {n} steps b then within {m} steps c",
    "require eventually (a and next eventually within {n} steps (b and next always c))",
    "require eventually (a and next eventually within {n} steps (b and next always for {m} steps c))",
    "require eventually (a and next eventually within {n} steps b) or always for {m} steps c",
    "require (eventually (a and next eventually within {n} steps b)) iff eventually c",
    "keep c implies eventually (a and next eventually within {n} steps b)",
)


def agree(clause: str, monkeypatch: pytest.MonkeyPatch, count: int, generator: random.Random, length: int) -> None:
    unfolded, timed = compiled(clause, monkeypatch, 10**9), compiled(clause, monkeypatch, 0)
    assert decode_artefact(json.loads(json.dumps(encode_artefact(timed))), "timed") == timed
    for _ in range(count):
        trace = random_trace(generator, length)
        for number, (expected, step) in enumerate(zip(steps(unfolded, trace), steps(timed, trace), strict=True)):
            where = (clause, trace[: number + 1])
            assert step.accepting == expected.accepting, where
            assert step.verdict in (expected.verdict, "holding" if step.accepting else "pending"), where


@pytest.mark.parametrize("form", CHAINS)
def test_chains_agree_with_unfolding_on_every_prefix(form: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(chains, "MOST_GOALS", 1)
    generator = random.Random(form)
    for n in (1, 2, 3, 5):
        clause = form.format(n=n + ("F[2" in form), m=generator.randint(1, n))
        if "F[2" not in form and "keep" not in form:
            assert {"chain"} & {atom.base for atom in compiled(clause, monkeypatch, 0).atoms} or n == 1, clause
        agree(clause, monkeypatch, 60, generator, 3 * n + 8)


@pytest.mark.parametrize("form", [form for form in RULES if "chain" in form or "sequence" in form])
def test_rules_of_deadlines_agree_with_chains_as_atoms(form: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(chains, "MOST_GOALS", 1)
    generator = random.Random(form)
    for n in (1, 3, 6):
        agree(RULES[form].format(n=n, m=generator.randint(1, n)), monkeypatch, 60, generator, 3 * n + 8)


def test_chains_agree_with_unfolding_on_random_formulas(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(chains, "MOST_GOALS", 1)
    assert agree_on_random_formulas(3, 80, monkeypatch) > 12


# --- long chains ------------------------------------------------------------------------------------


def long_chain(generator: random.Random, goals: int) -> tuple[list[str], list[int | None], str]:
    """Return the goals of a random chain, the bound of each but the first, and the chain as a clause."""
    names = [generator.choice("abc") for _ in range(goals)]
    bounds: list[int | None] = [generator.randint(1, 6) for _ in names[1:]]
    if generator.random() < 0.3:
        bounds[generator.randrange(len(bounds))] = None
    text = names[0]
    for name, bound in zip(names[1:], bounds, strict=True):
        text += f" then {name}" if bound is None else f" then within {bound} steps {name}"
    return names, bounds, f"reach {text}"


def is_reached(names: Sequence[str], bounds: Sequence[int | None], trace: Sequence[Sequence[bool]]) -> list[bool]:
    """Return for each prefix of a trace whether it has the goals in time, by definition: look at all samples."""
    at = [number for number, sample in enumerate(trace) if sample["abc".index(names[0])]]
    for name, bound in zip(names[1:], bounds, strict=True):
        at = [
            number
            for number, sample in enumerate(trace)
            if sample["abc".index(name)]
            and any(before < number and (bound is None or number - before <= bound) for before in at)
        ]
    return [any(number <= end for number in at) for end in range(len(trace))]


def test_long_chains_agree_with_the_definition(monkeypatch: pytest.MonkeyPatch) -> None:
    generator = random.Random(11)
    reached = 0
    for _ in range(40):
        names, bounds, clause = long_chain(generator, generator.randint(5, 14))
        timed = compiled(clause, monkeypatch, 0)
        assert len(timed.states) <= 20
        for _ in range(15):
            trace = random_trace(generator, 60)
            expected = is_reached(names, bounds, trace)
            found = list(steps(timed, trace))
            assert [step.accepting for step in found] == expected, (clause, trace)
            assert [step.verdict for step in found] == ["satisfied" if met else "pending" for met in expected]
            reached += expected[-1]
    assert reached > 60


def progress_of(fspa: Fspa, trace: Sequence[Sequence[bool]], lengths_s: Sequence[float | None]) -> list[float]:
    """Return the progress at each sample alone: of the state that is reached, and of the nearest edge from it."""
    progress, state, monitor = [], 0, Monitor(fspa)
    number = next((index for index, atom in enumerate(fspa.atoms) if atom.base == "chain"), None)
    for sample, length_s in zip(trace, lengths_s, strict=True):
        step = monitor.step(dict(zip("abc", sample, strict=True)), length_s)
        distance = fspa.states[step.state].distance
        assert distance is not None
        share = (fspa.spec_size - distance) / fspa.spec_size
        if step.state == state and distance and number is not None:
            share += 1 + min(0.0, monitor.values[number])
        state = step.state
        progress.append(share)
    return progress


@pytest.mark.parametrize("varies", [False, True], ids=["fixed", "varies"])
def test_progress_is_that_of_an_automaton_that_knows_the_attempts(
    varies: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    generator = random.Random(5)
    for _ in range(12):
        names, bounds, clause = long_chain(generator, generator.randint(2, 4))
        if None in bounds:
            continue
        clause = clause.replace(" steps", " s") if varies else clause
        clock = "clock varies " if varies else ""
        monkeypatch.setattr(chains, "MOST_GOALS", 4)
        states = compiled(clause, monkeypatch, 0, clock)
        monkeypatch.setattr(chains, "MOST_GOALS", 1)
        atom = compiled(clause, monkeypatch, 0, clock)
        for _ in range(60):
            trace = random_trace(generator, 20)
            lengths_s = [generator.choice((0.0, 0.5, 1.0, 1.0, 2.5)) if varies else None for _ in trace]
            done = [round(share * len(names)) for share in progress_of(states, trace, lengths_s)]
            # The values of the atoms are -1 and 1, so the nearness of the next goal adds nothing.
            found = [round(share * len(names)) for share in progress_of(atom, trace, lengths_s)]
            assert found == done, (clause, trace, lengths_s)


def test_the_next_goal_of_a_chain_adds_its_nearness() -> None:
    signals = "".join(f"signal x{number}: number in [-1, 1]\n" for number in range(6))
    chain = " then within 4 steps ".join(f"x{number} > 0" for number in range(6))
    (fspa,) = compile_text(f"{signals}spec s {{ reach {chain} }}")
    monitor, far = Monitor(fspa), {f"x{number}": -1.0 for number in range(6)}
    samples: tuple[tuple[dict[str, float], float], ...] = (
        ({}, 0.0),
        ({"x0": -0.25}, 0.75),
        ({"x0": 1.0}, 1.0),  # x1 counts from the next sample on
        ({"x1": -0.5}, 1.5),
        ({"x5": 1.0}, 1.0),
        ({}, 1.0),
        ({}, 0.0),  # x1 did not come within 4 steps
        ({"x0": 1.0}, 1.0),
        ({"x1": 1.0}, 2.0),
    )
    for changed, done in samples:
        monitor.step({**far, **changed})
        (value,) = (value for atom, value in zip(fspa.atoms, monitor.values, strict=True) if atom.base == "chain")
        assert value == pytest.approx(done / 6 - 1)


def chain_text(goals: int) -> str:
    signals = "".join(f"signal a{number}: bool\n" for number in range(goals))
    chain = " then within 5 s ".join(f"a{number}" for number in range(goals))
    return f"clock 60 Hz\n{signals}spec s {{ reach {chain} }}"


def test_long_chains_need_two_states_and_short_ones_know_their_goals() -> None:
    for goals, count in ((2, 3), (4, 9), (5, 2), (12, 2), (40, 2)):
        (fspa,) = compile_text(chain_text(goals))
        assert len(fspa.states) == count
        (varying,) = compile_text(chain_text(goals).replace("clock 60 Hz", "clock varies"))
        assert len(varying.states) == count
    (fspa,) = compile_text(chain_text(12))
    assert len("".join(map(str, emit("c", fspa).values()))) < 100_000


def test_a_chain_is_named_by_its_goals() -> None:
    words = (
        "a0, then a1 within 5 s after a0, then a2 within 5 s after a1, then a3 within 5 s after a2, then a4 within 5 s"
    )
    texts = {
        chain_text(5): f"Reach {words} after a3.",
        chain_text(5).replace("reach", "avoid"): f"Avoid {words} after a3 throughout.",
        chain_text(6).replace("a4 then within 5 s", "a4 then"): f"Reach {words} after a3, then a5.",
        chain_text(6).replace("a0 then within 5 s", "a0 then"): (
            "Reach a0, then a1 after a0, then a2 within 5 s after a1 after a0, then a3 within 5 s after a2, then a4"
            " within 5 s after a3, then a5 within 5 s after a4."
        ),
    }
    for text, said in texts.items():
        (fspa,) = compile_text(text)
        assert formula_text(fspa) == said
    (fspa,) = compile_text(chain_text(5))
    assert [failure.when for failure in explain(fspa).failures] == []
    (forbidden,) = compile_text(chain_text(5).replace("reach", "avoid"))
    assert [failure.when for failure in explain(forbidden).failures] == ["the chain from a0 to a4"]


def test_goals_of_a_chain_that_may_come_at_one_step_say_so() -> None:
    chain = "a4"
    for number in reversed(range(4)):
        chain = f"a{number} and eventually within 5 s ({chain})"
    text = chain_text(5)
    (fspa,) = compile_text(f"{text[: text.index('spec')]}spec s {{ reach {chain} }}")
    assert fspa.atoms[0].timer == Timer((False,) * 4)
    said = "Reach a0, then or at the same time a1 up to 5 s after a0, then or at the same time a2 up to 5 s after a1, "
    assert formula_text(fspa).startswith(said)
    assert formula_text(decode_artefact(json.loads(json.dumps(encode_artefact(fspa))), "chain")).startswith(said)


def test_a_chain_by_a_deadline_is_violated_when_no_attempt_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    goals = " and next eventually within 2 steps (".join("ababab")
    clause = f"require eventually within 4 steps ({goals}{')' * 6}"
    timed = compiled(clause, monkeypatch, 0)
    trace = [(False, False, False)] * 3 + [(True, False, False), (False, True, False)] + [(False, False, False)] * 4
    assert [step.verdict for step in steps(timed, trace)] == ["pending"] * 7 + ["violated"] * 2


@pytest.mark.parametrize("clock", ["60 Hz", "varies"])
def test_the_error_for_a_long_chain_inside_another_operator_says_how_to_write_it(clock: str) -> None:
    text = chain_text(9).replace("reach a0", "keep a0 implies (a0").replace("a8 }", "a8) }").replace("60 Hz", clock)
    with pytest.raises(TltlError) as caught:
        build(only_spec(text), state_budget=50)
    (problem,) = caught.value.diagnostics
    assert problem.code == "TLT0501"
    assert problem.help == (
        "a sequence with 8 times has up to 256 states inside another operator, and two as a `reach` or `avoid` clause"
        " of its own; otherwise leave out some of the times"
    )
