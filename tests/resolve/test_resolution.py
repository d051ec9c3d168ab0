"""The resolved form of programs: the paper's spec, and the fields of specs and tests."""

from __future__ import annotations

from tests.resolve.helpers import codes, formula, only_spec, resolve_text, valid_program
from tltlc.resolve.spec import Expect, RepeatedSample, Signal

COVER_AND_HIDE = """
import stealth
entity s1, s2, exit
exclusive near(s2), near(exit), near(s1)

/// Button 1, then button 2, then the exit, without dying.
spec cover_and_hide {
    level cover_and_hide
    limit 400 steps
    tag paper, slow
    reach near(s1) then near(s2) then near(exit)
    keep alive
}
"""


def test_cover_and_hide_resolves_to_the_formula_of_the_paper() -> None:
    spec = only_spec(COVER_AND_HIDE)
    assert str(spec.formula) == "F(near(s1) & X F(near(s2) & X F near(exit))) & G alive"
    assert [atom.name for atom in spec.atoms] == ["near(s1)", "near(s2)", "near(exit)", "alive"]
    assert spec.signals[0] == Signal(
        "distance", "length", 0.0, None, "Distance in a straight line from the character to `target`.", ("s1",)
    )
    assert [signal.name for signal in spec.signals] == ["distance(s1)", "distance(s2)", "distance(exit)", "health"]
    assert [(param.name, param.value, param.low, param.high) for param in spec.params] == [
        ("level_size", 20.0, 2.0, 10_000.0)
    ]
    assert spec.exclusive == ((0, 1, 2),)
    assert (spec.level, spec.limit_steps, spec.judge, spec.semantics) == ("cover_and_hide", 400, None, "finite")
    assert spec.tags == ("paper", "slow")
    assert spec.doc == "Button 1, then button 2, then the exit, without dying."
    assert [spec.source.slice(part.span) for part in spec.parts] == [
        "reach near(s1) then near(s2) then near(exit)",
        "keep alive",
    ]


def test_the_formula_form_and_the_clause_form_are_equal() -> None:
    text = """
    import stealth
    entity s1, s2, exit
    spec a { reach near(s1) then near(s2) then near(exit) keep alive }
    spec b = F(near(s1) & X F(near(s2) & X F near(exit))) & G alive
    """
    first, second = valid_program(text).specs
    assert first.formula is second.formula
    assert [str(part.formula) for part in second.parts] == [str(part.formula) for part in first.parts]


def test_parts_are_the_conjuncts_of_require() -> None:
    spec = only_spec(
        "signal a: bool signal b: bool spec s { require F a & (G b and (a -> b)) | false require (a and b) }"
    )
    assert [str(part.formula) for part in spec.parts] == ["F a & G b & (a -> b) | false", "a", "b"]


def test_each_clause_has_its_formula() -> None:
    text = "signal a: bool signal b: bool spec s { reach a keep b avoid a require a iff b }"
    assert formula(text) == "F a & G b & G !a & (a <-> b)"


def test_a_spec_has_the_metadata_of_its_clauses() -> None:
    spec = only_spec("clock 20 Hz signal a: bool spec s { limit 0.15 s judge at limit semantics infinite keep a }")
    assert (spec.limit_steps, spec.judge, spec.semantics, spec.clock_s) == (3, "limit", "infinite", 0.05)


def test_exclusive_atoms_come_last_and_only_where_two_are_used() -> None:
    text = """
    entity a, b, c
    signal at(x: entity): bool
    signal on: bool
    exclusive at(c), at(a), at(b)
    exclusive on, at(c)
    spec two = F at(b) & F at(a)
    spec one = F at(b) & G on
    """
    two, one = valid_program(text).specs
    assert [atom.name for atom in two.atoms] == ["at(b)", "at(a)", "at(c)"]
    assert two.exclusive == ((0, 1, 2),)
    assert [atom.name for atom in one.atoms] == ["at(b)", "on"]
    assert one.exclusive == ()


def test_a_test_block_resolves_to_samples_and_expectations() -> None:
    text = """
    signal alive: bool
    signal health: ratio
    spec s = G alive & F health >= 0.5
    test "t" for s {
        step 3x alive, not health < 0.5
        expect pending
        step health >= 50 %, not alive
        expect progress >= 0.5
        expect state "false"
    }
    """
    (test,) = valid_program(text).tests
    assert (test.title, test.spec) == ("t", "s")
    assert test.items[0] == RepeatedSample(3, frozenset({"alive"}))
    assert test.items[2] == RepeatedSample(1, frozenset())
    expectations = [item for item in test.items if isinstance(item, Expect)]
    assert [(e.kind, e.value, e.comparison) for e in expectations] == [
        ("verdict", "pending", None),
        ("progress", 0.5, ">="),
        ("state", "false", None),
    ]


def test_only_valid_specs_and_their_tests_are_kept() -> None:
    text = """
    signal a: bool
    spec bad { reach nothing keep b avoid nowhere }
    spec good = F a
    test "of the bad one" for bad { step a expect pending }
    test "of the good one" for good { step a expect satisfied }
    """
    program, diagnostics = resolve_text(text)
    assert [spec.name for spec in program.specs] == ["good"]
    assert [test.title for test in program.tests] == ["of the good one"]
    assert [diagnostic.code for diagnostic in diagnostics] == ["TLT0201"] * 3


def test_resolution_is_deterministic() -> None:
    assert resolve_text(COVER_AND_HIDE) == resolve_text(COVER_AND_HIDE)


def test_params_can_be_overridden_within_their_range() -> None:
    text = "import spatial entity e spec s = F near(e)"
    assert only_spec(text, params={"level_size": "35 m"}).params[0].value == 35
    assert only_spec(text, params={"level_size": " 1.5km "}).params[0].value == 1500
    assert only_spec(text, params={"level_size": "42"}).params[0].value == 42
    assert codes(text, params={"level_size": "42 s"}) == ["TLT0308"]
    assert codes(text, params={"level_size": "wide"}) == ["TLT0308"]
    assert codes(text, params={"level": "2"}) == ["TLT0308"]
    assert codes(text, params={"level_size": "1 m"}) == ["TLT0307"]
    speed = "signal v: speed in [0 m/s, 9 m/s] param top: speed in [1 m/s, 9 m/s] = 2 m/s spec s = F v > top"
    assert only_spec(speed, params={"top": "3 m/s"}).params[0].value == 3


def test_errors_are_in_the_order_of_the_text() -> None:
    text = "spec s = F a\nexclusive b, c\nlet l = G d\nspec t { reach e limit 3 }\npredicate p = f\nparam q = 3 m"
    _, diagnostics = resolve_text(text)
    starts = [diagnostic.labels[0].span.start for diagnostic in diagnostics]
    assert starts == sorted(starts)
    assert len(starts) == 7
