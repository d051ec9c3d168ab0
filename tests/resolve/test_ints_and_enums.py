"""Integers and enums: what compiles, the robustness of their atoms, and the atoms that exclude each other."""

from __future__ import annotations

from itertools import pairwise

import pytest

from tltlc import TltlError, compile_text
from tltlc.artefact.decode import decode
from tltlc.artefact.encode import encode
from tltlc.automaton.fspa import Fspa
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.expression.evaluate import evaluate
from tltlc.monitor import Monitor, MonitorError
from tltlc.monitor.spec_tests import run_tests
from tltlc.pipeline import compile_source
from tltlc.tools.lint.scopes import apply_edits

MODE = "signal mode: (idle, alert, chase)\n"
PHASE = "signal phase: int in [0, 5]\n"


def values(fspa: Fspa, atom: str, **sample: float) -> float:
    expression = next(item.expression for item in fspa.atoms if item.name == atom)
    return evaluate(expression, sample, {param.name: param.value for param in fspa.params})


def test_equality_holds_at_the_value_alone() -> None:
    (fspa,) = compile_text(PHASE + "spec a = F phase == 2")
    assert [values(fspa, "phase == 2", phase=float(value)) for value in range(6)] == pytest.approx(
        [-0.6, -0.2, 1.0, -0.2, -0.6, -1.0]
    )


def test_a_computed_integer_is_equal_up_to_a_half() -> None:
    (fspa,) = compile_text(PHASE + "spec a = F phase == 2")
    assert values(fspa, "phase == 2", phase=1.9999999) == pytest.approx(1 - 2e-7)
    assert values(fspa, "phase == 2", phase=2.5) == 0.0


def test_unequal_is_the_negation_of_equal() -> None:
    unequal, negated = compile_text(PHASE + "spec a = G phase != 2\nspec b = G !(phase == 2)")
    assert str(unequal.formula) == str(negated.formula) == "G !(phase == 2)"
    assert unequal.atoms == negated.atoms
    assert unequal.atoms[0].opposite == "phase != 2"


def test_a_constant_may_stand_on_the_left() -> None:
    left, right = compile_text(PHASE + "spec a = F 2 == phase\nspec b = F phase == 2")
    assert left.atoms == right.atoms


def test_arithmetic_of_integers_is_an_integer() -> None:
    text = PHASE + "param n: int in [0, 3] = 3\nsignal other: int in [-5, 5]\n"
    (fspa,) = compile_text(text + "spec a = F max(phase, 1) * 2 - n == abs(other) + 1")
    (atom,) = fspa.atoms
    for phase in range(6):
        for other in range(-5, 6):
            value = evaluate(atom.expression, {"phase": float(phase), "other": float(other)}, {"n": 3.0})
            assert (value > 0) == (max(phase, 1) * 2 - 3 == abs(other) + 1)
            assert -1 <= value <= 1


@pytest.mark.parametrize("value", range(3))
def test_the_robustness_of_an_enum_is_1_or_minus_1(value: int) -> None:
    (fspa,) = compile_text(MODE + "spec a = F mode is idle & F mode is alert & F mode is chase")
    names = ("mode is idle", "mode is alert", "mode is chase")
    assert [values(fspa, name, mode=float(value)) for name in names] == [
        1.0 if place == value else -1.0 for place in range(3)
    ]


def test_values_of_one_signal_exclude_each_other() -> None:
    text = MODE + PHASE + "signal other: (idle, alert, chase)\n"
    goals = ("mode is idle", "mode is not alert", "other is idle", "phase == 2", "phase == 3", "phase < 2")
    (fspa,) = compile_text(text + "spec a = " + " & ".join(f"F {goal}" for goal in goals))
    names = [atom.name for atom in fspa.atoms]
    groups = [{names[index] for index in group} for group in fspa.exclusive]
    assert groups == [{"mode is idle", "mode is alert"}, {"phase == 2", "phase == 3"}]
    # The atoms of other values are not brought along.
    assert "mode is chase" not in names


def test_values_of_one_count_exclude_each_other() -> None:
    (fspa,) = compile_text(
        "signal p: bool spec a = F times(p) == 1 & F times(p, 9) == 2 & F previous(times(p, 9)) == 3 & F p"
    )
    names = [atom.name for atom in fspa.atoms]
    assert [[names[index] for index in group] for group in fspa.exclusive] == [["times(p) == 1", "times(p, 9) == 2"]]


def test_an_equality_with_a_param_excludes_nothing() -> None:
    (fspa,) = compile_text(PHASE + "param n: int in [0, 5] = 2\nspec a = F phase == n & F phase == 2")
    assert fspa.exclusive == ()


def test_a_declared_group_is_not_repeated() -> None:
    (fspa,) = compile_text(MODE + "exclusive mode is idle, mode is alert\nspec a = F mode is idle & F mode is alert")
    assert fspa.exclusive == ((0, 1),)


def test_no_sample_breaks_the_groups_of_values() -> None:
    (fspa,) = compile_text(
        "signal phase: int in [0, 9007199254740992]\n"
        "spec a = F phase == 0 & F phase == 1 & F phase == 9007199254740990 & F phase == 9007199254740991"
    )
    assert len(fspa.exclusive) == 1
    for low, high in pairwise([0.0, 0.5, 1.0, 1.5, 2.0]):
        middle = (low + high) / 2
        for value in (low, middle, 0.49999999999999994, 0.5000000000000001, 9007199254740990.0, 9007199254740991.0):
            Monitor(fspa).step({"phase": value})


def test_values_with_entities_and_in_lets_and_quantifiers() -> None:
    (fspa,) = compile_text(
        "entity guards = g1, g2\n"
        "signal mode(g: entity): (idle, alert, chase)\n"
        "let calm(g: entity) = mode(g) is not chase\n"
        "spec a = G all g in guards: calm(g)"
    )
    assert str(fspa.formula) == "G(!(mode(g1) is chase) & !(mode(g2) is chase))"
    assert [signal.values for signal in fspa.signals] == [("idle", "alert", "chase")] * 2


def test_conditions_of_predicates_take_integers_and_enums() -> None:
    (fspa,) = compile_text(
        MODE + PHASE + "// tltlc: allow TLT0402\n"
        "predicate p(k: int) = when phase == k: 0.1 when mode is not idle: 0.2 otherwise: 0.3\nspec a = F p(2)"
    )
    assert values(fspa, "p(2)", phase=2.0, mode=1.0) == 0.1
    assert values(fspa, "p(2)", phase=3.0, mode=1.0) == 0.2
    assert values(fspa, "p(2)", phase=3.0, mode=0.0) == 0.3


def test_is_and_the_names_of_values_are_no_reserved_words() -> None:
    (fspa,) = compile_text("signal is: (is, step, at)\nspec a = F is is is & F is is not step")
    assert [atom.name for atom in fspa.atoms] == ["is is is", "is is step"]


def test_tests_name_values() -> None:
    text = MODE + PHASE + "spec a = F (mode is alert & X phase == 2)\n"
    text += 'test "both" for a { step mode is alert  expect pending  step phase == 2  expect satisfied }'
    compiled = compile_source(SourceFile("specs.tltl", text))
    (result,) = run_tests(compiled.program, compiled.automata)
    assert result.failure is None


def test_a_monitor_takes_names_and_numbers() -> None:
    (fspa,) = compile_text(MODE + "spec a = F mode is alert")
    assert Monitor(fspa).step({"mode": "alert"}) == Monitor(fspa).step({"mode": 1})
    with pytest.raises(MonitorError) as error:
        Monitor(fspa).step({"mode": "alrt"})
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "TLT0612"
    assert diagnostic.help == "its values are `idle`, `alert` and `chase`, or the numbers from 0 to 2"


@pytest.mark.parametrize(
    ("clause", "meant"),
    [
        ("keep seen == true", "keep seen"),
        ("keep seen != true", "keep not seen"),
        ("keep coins == 0 or seen", "keep coins <= 0 or seen"),
        ("keep heat == 3", "keep heat >= 3 and heat <= 3"),
        ("keep F coins + 1 == fuel", "keep F (coins + 1 >= fuel and coins + 1 <= fuel)"),
        ("keep heat != 3 or seen", "keep (heat < 3 or heat > 3) or seen"),
        ("keep mode == alert", "keep mode is alert"),
        ("keep mode != alert", "keep mode is not alert"),
        ("keep mode is alrt", "keep mode is alert"),
    ],
)
def test_the_fix_of_an_equality_gives_the_intended_clause(clause: str, meant: str) -> None:
    signals = MODE + "signal seen: bool  signal coins in [0, 50]  signal fuel in [0, 50]  signal heat in [0, 7.5]\n"
    source = SourceFile("a.tltl", f"{signals}spec s {{ {clause} }}")
    (diagnostic,) = compile_errors(source)
    assert apply_edits(source, diagnostic.fixes[0].edits).text == f"{signals}spec s {{ {meant} }}"


def compile_errors(source: SourceFile) -> tuple[Diagnostic, ...]:
    with pytest.raises(TltlError) as error:
        compile_source(source)
    return tuple(error.value.diagnostics)


def test_a_param_of_type_int_takes_whole_numbers_alone() -> None:
    (fspa,) = compile_text(PHASE + "param n: int in [0, 5] = 2\nspec a = F phase == n")
    assert Monitor(fspa, {"n": 4}).step({"phase": 4}).accepting
    with pytest.raises(MonitorError, match="it is an int"):
        Monitor(fspa, {"n": 2.5})


def test_types_and_names_survive_the_artefact() -> None:
    (fspa,) = compile_text(MODE + PHASE + "spec a = F mode is alert & G phase != 3")
    document = encode(fspa)
    assert document["signals"][0] == {
        "name": "mode",
        "type": "int",
        "range": [0.0, 2.0],
        "values": ["idle", "alert", "chase"],
    }
    assert "values" not in document["signals"][1]
    again = decode(document, "a")
    assert again == fspa
    assert [atom.opposite for atom in again.atoms] == ["mode is not alert", "phase != 3"]


def test_an_artefact_whose_names_do_not_fit_the_range_is_refused() -> None:
    (fspa,) = compile_text(MODE + "spec a = F mode is alert")
    document = encode(fspa)
    document["signals"][0]["values"].append("asleep")
    with pytest.raises(TltlError) as error:
        decode(document, "a")
    assert error.value.diagnostics[0].code == "TLT0604"
