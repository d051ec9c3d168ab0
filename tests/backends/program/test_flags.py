"""Atoms and registers that are only -1 or 1 are Booleans of a program, which computes the same as the monitor."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Final

import pytest

from tests.backends.program.following import any_value, follow
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import schedule
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.expression.tree import AtomValue, Before, Const, Op, SignalValue
from tltlc.program.build import program
from tltlc.program.flags import Flags
from tltlc.program.tree import Assign, Choice, Declare, If, ProgramVariable, Statement
from tltlc.program.used_names import functions_called, parts
from tltlc.resolve.spec import Signal

DECLARATIONS: Final = """
clock 10 Hz
signal p: bool
signal q: bool
signal r: bool
signal u: bool
signal hp in [0, 10]
signal x in [-4, 4]
signal mode: (idle, alert, chase)
signal c: bool
signal d: bool
exclusive c, d
let danger = p or hp < 3
"""
_FLAGS: Final = (
    *("p", "q", "r", "u", "c", "d", "mode is alert", "begins p", "ends q", "once r", "previously u", "p since q"),
    *("(p and q)", "(p or r)", "historically u", "(q iff r)"),
)
_NUMBERS: Final = (
    *("danger", "hp < 3", "x > 1", "once (x > 2)", "hp > previous(hp)", "times(p) > 2", "begins (x > 1)"),
    *("highest(x) > 2", "time_holding(q) >= 0.5 s", "once within 0.4 s r", "(p implies x > 1)"),
)
_CLAUSES: Final = (
    "keep {a} implies eventually within {t} s {b}",
    "keep {a} implies next always for {t} s not {b}",
    "keep {a} implies always for {t} s {b}",
    "keep {a} implies once {b}",
    "keep not ({a} and {b})",
    "reach {a} then within {t} s {b}",
    "reach ({a} and {b}) or {c}",
    "keep {a} implies next {b}",
    "require eventually within {t} s {a}",
    "require always for {t} s ({a} implies {b})",
    "require always eventually {a}",
    "require {a} until {b}",
)


def random_automaton(rng: Random) -> Fspa | None:
    """Return the automaton of a random spec with timers and memory; None if it has none, an error, or many states."""

    def part() -> str:
        return rng.choice(_FLAGS if rng.random() < 0.7 else _NUMBERS)

    clauses = [
        rng.choice(_CLAUSES).format(a=part(), b=part(), c=part(), t=rng.choice(("0.3", "1", "8", "9")))
        for _ in range(rng.randint(1, 5))
    ]
    try:
        (fspa,) = compile_text(DECLARATIONS + "spec s {\n" + "\n".join(clauses) + "\n}\n")
    except TltlError:
        return None
    return fspa if fspa.registers and len(fspa.states) <= 60 else None


def test_programs_of_random_specs_agree_with_the_monitor() -> None:
    count = 0
    for seed in range(120):
        rng = Random(f"flags {seed}")
        fspa = random_automaton(rng)
        if fspa is None:
            continue
        count += 1
        follow(fspa, rng, rng.choice((10, 130)), has_bools=rng.random() < 0.5, draw=_drawn(rng.choice((0.05, 0.5))))
    assert count > 80


def _drawn(share: float) -> Callable[[Signal, Random], float]:
    """Return a function that draws samples in which a Boolean is true as often as ``share`` says, or less."""
    held = Random(share)

    def value(signal: Signal, rng: Random) -> float:
        if signal.name == "d":
            return 0.0
        return float(held.random() < share) if signal.type == "bool" else any_value(signal, rng)

    return value


def flags_of(text: str) -> tuple[Fspa, Flags]:
    (fspa,) = compile_text(f"clock 10 Hz\n{text}")
    return fspa, Flags(fspa, schedule(fspa))


def test_what_is_remembered_of_bool_signals_are_flags() -> None:
    fspa, flags = flags_of("signal p: bool\nsignal q: bool\nspec s { keep begins p implies eventually within 9 s q }")
    kinds = {register.kind for register in fspa.registers if register.name in flags}
    assert kinds == {"last", "previously", "due"}
    assert {register.kind for register in fspa.registers if register.name not in flags} == {"waiting"}
    assert all(Before(register.name) in flags for register in fspa.registers if register.name in flags)
    assert [atom.base for atom in fspa.atoms if AtomValue(atom.name) not in flags] == ["late"]


@pytest.mark.parametrize("text", ["x > 1", "p and x > 1", "p or previously (x > 1)", "times(p) > 2"])
def test_what_is_remembered_of_numbers_are_no_flags(text: str) -> None:
    fspa, flags = flags_of(f"signal p: bool\nsignal x in [0, 4]\nspec s {{ reach once ({text}) }}")
    assert not [register for register in fspa.registers if register.kind == "once" and register.name in flags]


def test_a_register_that_may_leave_two_values_is_no_flag() -> None:
    fspa, _ = flags_of("signal p: bool\nspec s { reach once p }")
    (once,) = fspa.registers
    for update, is_flag in (
        (once.update, True),
        (Const(1.0), True),
        (Const(0.5), False),
        (Op("*", (Before(once.name), Const(-1.0))), True),
        (Op("+", (Before(once.name), Const(1.0))), False),
        (SignalValue("p"), False),
    ):
        changed = replace(fspa, registers=(replace(once, update=update),))
        assert (once.name in Flags(changed, schedule(changed))) == is_flag
        follow(changed, Random(1), 10, draw=_drawn(0.5))
    changed = replace(fspa, registers=(replace(once, initial=0.0),))
    assert once.name not in Flags(changed, schedule(changed))


def test_exclusive_atoms_are_numbers() -> None:
    (fspa,) = compile_text("signal p: bool\nsignal q: bool\nexclusive p, q\nspec s { keep once p implies q }")
    found = program(fspa, ())
    for atom, value in zip(fspa.atoms, found.values, strict=True):
        assert any(isinstance(statement, Declare) for statement in value) == (atom.name == "once p")
    follow(fspa, Random(2), 20, draw=lambda signal, rng: float(signal.name == "p" and rng.random() < 0.3))


def test_a_number_is_computed_only_where_its_flag_holds() -> None:
    (fspa,) = compile_text(
        "clock 10 Hz\nsignal p: bool\nsignal q: bool\nspec s { keep p implies next always for 9 s not q }"
    )
    found = program(fspa, ())
    (breach,) = [update for register, update in zip(fspa.registers, found.updates) if register.kind == "breach"]  # noqa: B905
    assert [type(statement.value) for statement in breach if isinstance(statement, Assign)] == [Choice]
    assert not functions_called(breach)


def test_atoms_that_break_a_rule_alone_are_compared_by_their_maximum() -> None:
    clauses = "".join(f"keep p{i} implies eventually within 9 s q{i}\n" for i in range(3))
    signals = "".join(f"signal p{i}: bool\nsignal q{i}: bool\n" for i in range(3))
    (fspa,) = compile_text(f"clock 10 Hz\n{signals}spec s {{\n{clauses}}}\n")
    found = follow(fspa, Random(3), 300, draw=_drawn(0.02))
    assert {node.name for case in found.cases for node in _variables(case.statements)} >= {"worst"}


def _variables(statements: tuple[Statement, ...]) -> list[ProgramVariable]:
    values = [test for s in statements if isinstance(s, If) for test, _ in s.cases]
    return [node for node in parts(values) if isinstance(node, ProgramVariable)]


def test_states_that_share_code_have_flags_too() -> None:
    text = f"signal p: bool\nsignal q: bool\nspec s {{ require {'next ' * 70}(q and once p) }}"
    (fspa,) = compile_text(text)
    assert follow(fspa, Random(4), 100, draw=_drawn(0.5)).tables is not None
