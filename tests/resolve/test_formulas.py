"""Lets, quantifiers, names of atoms, and large texts."""

from __future__ import annotations

import pytest

from tests.resolve.helpers import codes, formula, only_spec, resolve_text, valid_program
from tltlc.resolve.declared_values import signal
from tltlc.resolve.kinds import entity

AT = "entity e1, e2, e3 signal at(x: entity): bool signal a: bool signal b: bool "


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("let goal = F a spec s = goal & G b", "F a & G b"),
        ("let visit(x: entity) = F at(x) spec s = visit(e2)", "F at(e2)"),
        ("let both(p, q: formula) = F (p & X F q) spec s = both(a, G b)", "F(a & X F G b)"),
        ("let both(p, q) = F p & F q spec s = both(q = a, p = b)", "F b & F a"),
        ("let twice(p) = p & X p spec s = twice(twice(a))", "a & X a & X(a & X a)"),
        ("let f(x, p) = p & at(x) spec s = F f(e1, a or b)", "F((a | b) & at(e1))"),
        ("let wait(x: entity = e3) = F at(x) spec s = wait & wait(e1)", "F at(e3) & F at(e1)"),
        ("spec s = all x in (e1, e2): F at(x)", "F at(e1) & F at(e2)"),
        ("spec s = any x in (e1, e2): G at(x)", "G at(e1) | G at(e2)"),
        ("spec s = a & all x in (e1, e2): b & at(x)", "a & b & at(e1) & b & at(e2)"),
        ("spec s = all x in (e1, e2): any y in (e3, x): at(y)", "(at(e3) | at(e1)) & (at(e3) | at(e2))"),
        ("let a2(x) = all y in (x, e3): at(y) spec s = G a2(e1)", "G(at(e1) & at(e3))"),
        ("spec s = all a in (e1, e2): F at(a)", "F at(e1) & F at(e2)"),
        ("spec s { reach a then b then at(e1) }", "F(a & X F(b & X F at(e1)))"),
        ("spec s { reach (a then b) then at(e1) }", "F(F(a & X F b) & X F at(e1))"),
        ("spec s = (F a) then b", "F(F a & X F b)"),
        ("spec s = a -> b <-> not a W b", "a -> b <-> !a W b"),
        ("spec s = true & !false", "true & !false"),
    ],
)
def test_lets_and_quantifiers_expand_to_their_meaning(written: str, meant: str) -> None:
    assert formula(AT + written) == meant


@pytest.mark.parametrize(
    ("use", "name"),
    [
        ("p(e)", "p(e)"),
        ("p(e, close = 3 m)", "p(e, close=3)"),
        ("p(x = e, close = 300 cm)", "p(e, close=3)"),
        ("p(e, 1 m)", "p(e)"),
        ("p(e, far = size)", "p(e)"),
        ("p(e, far = 2 * size, close = 2 m)", "p(e, close=2, far=2 * size)"),
        ("p(e, far = 5 m + 0.5 m)", "p(e, far=5.5)"),
        ("p(e, share = 12.5 %)", "p(e, share=0.125)"),
    ],
)
def test_names_of_atoms_are_canonical(use: str, name: str) -> None:
    declared = """
    entity e
    signal d(x: entity): length in [0 m, 90 m]
    param size: length in [10 m, 20 m] = 15 m
    predicate p(x: entity, close: length = 1 m, far: length = size, share: ratio = 50 %) in [-1, 1] =
        clamp((close - d(x)) / far + share, -1, 1)
    """
    (atom,) = only_spec(f"{declared} spec s = F {use}").atoms
    assert atom.name == name


def test_a_predicate_takes_entities_as_arguments_and_defaults() -> None:
    text = """
    entity a, b
    signal d(x: entity, y: entity): length in [0 m, 90 m]
    predicate apart(x: entity, y: entity = b) in [0, 1] = d(x, y) / 90 m
    spec s = F apart(b, a) & F apart(a)
    """
    spec = only_spec(text)
    assert [atom.name for atom in spec.atoms] == ["apart(b, y=a)", "apart(a)"]
    assert [signal.name for signal in spec.signals] == ["d(b, a)", "d(a, b)"]


def test_predicates_may_use_predicates() -> None:
    text = """
    signal x: ratio
    predicate low(most: ratio = 50 %) in [-1, 1] = clamp((most - x) / most, -1, 1)
    predicate both in [-1, 1] = min(low, low(20 %))
    spec s = F both
    """
    assert [signal.name for signal in only_spec(text).signals] == ["x"]


def test_a_numeric_argument_may_be_a_signal() -> None:
    text = "import core signal fuel: ratio spec s = F above(fuel, 0.5, 0.1)"
    assert [atom.name for atom in only_spec(text).atoms] == ["above(fuel, 0.5, 0.1)"]


def test_unused_declarations_are_checked_once() -> None:
    assert codes("signal a: bool let l(p) = p & nothing spec s = F a") == ["TLT0201"]
    assert codes("signal a: bool let l(p: formula, x: entity) = F p spec s = F a") == []
    assert codes("signal a: bool predicate p(x: entity) in [-1, 1] = nothing spec s = F a") == ["TLT0201"]
    assert codes("signal a: bool predicate p(n: length) in [-1, 1] = n spec s = F a") == ["TLT0305"]
    assert codes("signal a: bool let l = nothing spec s = F l & G l spec t = X l") == ["TLT0201"]


def test_a_cycle_is_reported_once_and_named() -> None:
    _, diagnostics = resolve_text("signal a: bool let x = a & y let y = X z let z = F x spec s = y & x spec t = z")
    assert [(d.code, d.title) for d in diagnostics] == [
        ("TLT0207", "`y` is defined in terms of itself: y -> z -> x -> y")
    ]


def test_two_predicates_with_the_same_name_are_an_error(tmp_path: object) -> None:
    from pathlib import Path

    folder = Path(str(tmp_path))
    for name, sign in (("one", ""), ("two", "-")):
        (folder / f"{name}.tltl").write_text(f"signal x in [-1, 1] predicate p in [-1, 1] = {sign}x")
    text = "import one as a import two as b spec s = F a.p & G b.p"
    assert [d.code for d in resolve_text(text, str(folder / "main.tltl"))[1]] == ["TLT0216"]


def test_a_long_chain_of_operators_resolves() -> None:
    spec = only_spec("signal a: bool signal b: bool spec s = " + " & ".join(["a", "X b"] * 450))
    assert len(spec.parts) == 900
    mixed = only_spec("signal a: bool spec s = F (" + " | ".join(["a & !a"] * 900) + ")")
    assert len(mixed.formula.args[0].args) == 900


def test_long_chains_of_implications_and_prefixes_resolve() -> None:
    text = "signal a: bool spec s = " + " -> ".join(["a"] * 900) + " spec t = " + "X " * 900 + "a"
    first, second = valid_program(text).specs
    assert (first.formula.op, second.formula.op) == ("implies", "X")


def test_a_long_chain_of_lets_resolves() -> None:
    lets = " ".join(f"let l{i} = X l{i + 1}" for i in range(3_000))
    assert only_spec(f"signal a: bool {lets} let l3000 = a spec s = l0").formula.op == "X"


def test_deep_brackets_resolve() -> None:
    assert formula("signal a: bool spec s = " + "(" * 150 + "a" + ")" * 150) == "a"
    assert codes("signal x in [0, 1] spec s = F " + "(" * 150 + "x" + ")" * 150 + " > 0.5") == []


def test_exponential_growth_is_an_error() -> None:
    doubling = " ".join(f"let d{i + 1} = d{i} & X d{i}" for i in range(60))
    assert codes(f"signal a: bool let d0 = F a {doubling} spec s = d60") == ["TLT0315"]
    silent = " ".join(f"let d{i + 1}(p) = d{i}(p & a) | d{i}(p | a)" for i in range(60))
    # The work of all lets in a program is counted together.
    again = silent.replace("d", "e")
    assert codes(f"signal a: bool let d0(p) = a {silent} let e0(p) = a {again} spec s = d60(a) & e60(a)") == ["TLT0315"]


def test_growth_of_defaults_is_an_error() -> None:
    # Without a limit, the last default would not fit into any memory.
    formulas = ", ".join(f"p{i + 1} = (p{i} & p{i})" for i in range(60))
    assert codes(f"signal a: bool let d(p0 = a, {formulas}) = p0 spec s = F d") == ["TLT0315"]
    numbers = ", ".join(f"p{i + 1} = (p{i} + p{i}) / 2" for i in range(60))
    text = f"signal x in [0, 1] predicate d(p0 = x, {numbers}) in [0, 1] = p0"
    assert set(codes(f"{text} spec s = F d")) == {"TLT0315"}
    assert codes(text) == ["TLT0315"]


def test_deep_arithmetic_is_an_error_not_a_crash() -> None:
    long = " + ".join(["x"] * 900)
    assert codes(f"signal x in [0, 1] spec s = F ({long}) > 0.5") == ["TLT0317"]
    chain = " ".join(f"predicate p{i} in [-1, 1] = -p{i + 1}" for i in range(2_000))
    reported = codes(f"signal x in [-1, 1] {chain} predicate p2000 in [-1, 1] = x spec s = F p0")
    assert set(reported) == {"TLT0317"}
    # There is about one error for each hundred predicates of the chain, not one for each predicate.
    assert len(reported) < 50


def test_signals_inside_quantifiers_are_resolved_once_for_each_entity(monkeypatch: pytest.MonkeyPatch) -> None:
    from tltlc.resolve import formulas

    calls: list[object] = []
    monkeypatch.setattr(formulas, "signal", lambda *arguments: calls.append(arguments) or signal(*arguments))
    names = ", ".join(f"g{i}" for i in range(10))
    text = f"entity {names} signal at(x: entity): bool spec s = "
    quantifiers = " ".join(f"all {v} in ({names}):" for v in "xyz")
    spec = only_spec(f"{text}{quantifiers} F (at(x) | at(y))")
    assert spec.formula.op == "and"
    assert len(spec.formula.args) == 1000
    assert len(calls) == 20


def test_a_quantifier_stops_as_soon_as_it_is_too_large(monkeypatch: pytest.MonkeyPatch) -> None:
    from tltlc.resolve import groups

    calls: list[object] = []
    monkeypatch.setattr(groups, "entity", lambda *arguments: calls.append(arguments) or entity(*arguments))
    names = ", ".join(f"g{i}" for i in range(300))
    text = f"entity {names} signal at(x: entity): bool spec s = all x in ({names}): all y in ({names}): "
    _, (diagnostic,) = resolve_text(f"{text} F (at(x) & at(y))")
    assert (diagnostic.code, diagnostic.title) == ("TLT0315", "`all x` expands to more than 100,000 parts")
    assert len(calls) < 30_000


def test_an_error_in_a_definition_labels_its_first_uses() -> None:
    lets = " ".join(f"let f{i}(x) = f{i - 1}(x)" for i in range(1, 9))
    text = f"signal d: length in [0 m, 9 m] let f0(x) = d < x {lets} spec s = F f8(3)"
    _, (diagnostic,) = resolve_text(text)
    assert diagnostic.code == "TLT0305"
    assert [label.source.slice(label.span) for label in diagnostic.labels] == ["x", "f0(x)", "f1(x)", "f2(x)"]
    assert {label.message for label in diagnostic.labels[1:]} == {"used here"}


@pytest.mark.parametrize("parameter", ["", "(x: entity)"])
def test_an_error_that_no_argument_causes_labels_only_the_definition(parameter: str) -> None:
    _, (diagnostic,) = resolve_text(
        f"{AT} signal d in [0, 1] let f{parameter} = d < 3 m spec s = F f{parameter and '(e1)'}"
    )
    assert (diagnostic.code, len(diagnostic.labels)) == ("TLT0305", 1)


def test_an_error_deep_inside_lets_is_reported() -> None:
    lets = " ".join(f"let f{i}(x) = X f{i - 1}(x)" for i in range(1, 3000))
    assert codes(f"signal d in [0, 1] let f0(x) = d < x {lets} spec s = f2999(3 m)") == ["TLT0305"]


def test_an_unused_let_may_pass_untyped_parameters_on() -> None:
    lets = "let low(x) = d < x let never_low(x) = G !low(x) let both(x) = low(x) & F low(1 - x)"
    assert formula(f"signal d in [0, 1] {lets} spec s = F low(0.5)") == "F(d < 0.5)"


def test_defaults_that_grow_exponentially_are_rejected() -> None:
    formulas = ", ".join(f"a{number + 1} = (a{number} & a{number})" for number in range(60))
    assert codes(f"signal y: bool let p(a0 = y, {formulas}) = a0 spec s = F p") == ["TLT0315"]
    numbers = ", ".join(f"a{number + 1} = (a{number} + a{number}) / 2" for number in range(40))
    assert codes(f"signal x in [0, 1] predicate p(a0 = x, {numbers}) in [-1, 1] = a40 spec s = F p") == ["TLT0315"]
    assert codes(f"signal x in [0, 1] let p(a0 = x, {numbers}) = a40 > 0 spec s = F p") == ["TLT0315"]
