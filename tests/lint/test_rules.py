"""What rules find and what they let pass, beyond the examples of their pages."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import tltlc
from tests.lint.helpers import codes, found, marked
from tltlc.automaton.build import build, spec_from_formula
from tltlc.comparison import are_equivalent, is_included
from tltlc.lint.rules import implied_clause
from tltlc.lint.run import view_of
from tltlc.logic.formula import Formula, and_
from tltlc.pipeline import CompileOptions, compile_source
from tltlc.source import SourceFile

EXAMPLES = Path(__file__).parents[2] / "examples"
SIGNALS = "signal a: bool signal b: bool signal c: bool\n"
RANGES = "signal x in [0, 10]\nsignal y in [0, 10]\n" + SIGNALS
HEAD = "spec s {\n    limit 9 steps\n    judge at goal\n    "


def block(*clauses: str, before: str = SIGNALS) -> str:
    """A spec of these clauses that has a limit and says when it is judged, so that nothing is said of that."""
    return before + HEAD + "\n    ".join(clauses) + "\n}\n"


def of(code: str, *clauses: str, before: str = SIGNALS) -> list[str]:
    """What a rule points at in a spec of these clauses."""
    return marked(block(*clauses, before=before), code)


# --- TLT0412 --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("reach a implies b", ["a implies b"]),
        ("reach (a -> b) then c", ["a -> b"]),
        ("reach a then ((b -> c))", ["b -> c"]),
        ("require F (a -> F b)", ["a -> F b"]),
        ("require G (c -> F (a -> b))", ["a -> b"]),
        ("require (a -> b) then c", ["a -> b"]),
        ("require eventually within 3 steps (a -> b)", ["a -> b"]),
        ("require F ((a -> b) & !c)", ["a -> b"]),
        ("keep a implies b", []),
        ("require G (a -> F b)", []),
        ("reach a and (b -> c)", []),
        ("reach not a implies b", []),
        ("reach not a", []),
        ("reach not a or b", ["not a or b"]),
        ("reach (b or not a) then c", ["b or not a"]),
        ("reach (not a and not b) or c", ["(not a and not b) or c"]),
        ("reach (a and not b) or c", []),
        ("reach not a and b", []),
        ("reach a implies (b until c)", ["a implies (b until c)"]),
        ("require not F (a -> b)", []),
        ("reach a iff b", []),
    ],
)
def test_goals_that_are_implications(clause: str, expected: list[str]) -> None:
    assert of("TLT0412", clause) == expected


@pytest.mark.parametrize(
    ("clauses", "is_found"),
    [
        (("reach a implies b", "keep a"), False),
        (("reach not a or b", "keep c"), True),
        (("reach c and (a implies b)", "keep c"), True),
        (("reach c and (a implies b)",), False),
        (("reach a implies b", "require G (a or c)", "avoid c"), False),
        (("reach a implies b", "require a"), True),
        (("reach a implies b", "reach b"), True),
    ],
)
def test_what_the_other_clauses_ask_counts(clauses: tuple[str, ...], is_found: bool) -> None:
    assert bool(of("TLT0412", *clauses)) == is_found


def test_the_papers_formula_as_it_is_printed() -> None:
    text = (EXAMPLES / "branching.tltl").read_text(encoding="utf-8").replace("tltlc: allow", "")
    assert marked(text, "TLT0412") == ["open_right implies near(e_right)"]
    assert len(codes(text)) == 1


# --- TLT0413 and TLT0425 --------------------------------------------------------------------------

ATOMS = ("a", "b", "c")
SMALL = st.recursive(
    st.sampled_from(ATOMS),
    lambda inner: (
        st.tuples(st.sampled_from(["!({})", "F ({})", "G ({})", "X ({})", "N ({})"]), inner).map(
            lambda each: each[0].format(each[1])
        )
        | st.tuples(st.sampled_from(["({}) & ({})", "({}) | ({})", "({}) U ({})", "({}) -> ({})"]), inner, inner).map(
            lambda each: each[0].format(each[1], each[2])
        )
    ),
    max_leaves=4,
)


def automaton(formulas: list[Formula]) -> tltlc.Fspa:
    return build(spec_from_formula(and_(*formulas)))


@settings(deadline=None)
@given(st.lists(SMALL, min_size=2, max_size=4))
def test_what_is_implied_can_be_left_out_and_by_what_it_is_implied(clauses: list[str]) -> None:
    text = block(*(f"require ({clause})" for clause in clauses))
    (spec,) = compile_source(SourceFile("example.tltl", text)).program.specs
    assume(build(spec).states[0].verdict != "violated")
    at = {part.span: part.formula for part in spec.parts}
    # What another rule supersedes is implied all the same.
    implied = [
        each.labels for each in implied_clause.check(view_of(SourceFile("example.tltl", text), CompileOptions()))
    ]
    for part, *reasons in implied:
        assert is_included(automaton([at[reason.span] for reason in reasons]), automaton([at[part.span]]))
    gone = {labels[0].span for labels in implied}
    twice = {labels.span for labels in (e.diagnostic.labels[0] for e in found(text) if e.diagnostic.code == "TLT0425")}
    left = [part.formula for part in spec.parts if part.span not in gone | twice]
    assert are_equivalent(automaton([part.formula for part in spec.parts]), automaton(left))
    for formula in left if len(left) > 1 else ():
        others = [other for other in left if other is not formula]
        # What is always true is implied by nothing in particular; another warning speaks of it.  And clauses that
        # share no atom are not compared: the one could imply the other only by how long the trace may be.
        share = set(formula.atoms()) & {name for other in others for name in other.atoms()}
        if share and automaton([formula]).states[0].verdict != "satisfied":
            assert not is_included(automaton(others), automaton([formula]))


def test_over_infinite_traces_other_clauses_are_implied() -> None:
    clauses = ("require G F a", "require G F (a or b)")
    assert of("TLT0413", "semantics infinite", *clauses) == ["G F (a or b)"]
    assert of("TLT0413", "semantics infinite", "require F G a", "require G F (a or b)") == ["G F (a or b)"]


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("reach a", "keep x > 5", "keep x > 3"), ["keep x > 3"]),
        (("reach a", "keep x > 3", "keep x > 5"), ["keep x > 3"]),
        (("reach a", "keep x > 5", "avoid x < 3"), ["avoid x < 3"]),
        (("reach x > 5", "reach x > 3"), ["reach x > 3"]),
        (("reach a", "keep x > 5", "keep x < 7"), []),
        (("reach a", "keep x > 5", "keep y > 3"), []),
        (("reach x > 3 then a", "reach x > 5"), []),
    ],
)
def test_what_comparisons_say_of_each_other_may_imply_a_clause(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert of("TLT0413", *clauses, before=RANGES) == expected


def test_what_excludes_an_atom_may_imply_its_absence() -> None:
    exclusive = SIGNALS + "exclusive a, b\n"
    assert of("TLT0413", "keep a", "avoid b", before=exclusive) == ["avoid b"]
    assert of("TLT0413", "keep a", "avoid b") == []


# --- TLT0414 and TLT0415 --------------------------------------------------------------------------

PLACES = "entity x, y, z\nsignal d(e): length in [0 m, 9 m]\npredicate at(e: entity) = 1 - 2 * d(e) / 9 m\n"
APART = PLACES + "exclusive at(x), at(y)\n"


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("reach at(x) and at(y)", ["at(x) and at(y)"]),
        ("reach at(z) then (at(x) and at(y))", ["at(x) and at(y)"]),
        ("require F (at(x) & F at(z) & at(y))", ["at(x) & F at(z) & at(y)"]),
        ("require F all e in (x, y): at(e)", ["all e in (x, y): at(e)"]),
        ("reach at(x) and at(z)", []),
        ("reach at(x) and not at(y)", []),
        ("reach at(x) then at(y)", []),
        ("reach at(x) or at(y)", []),
    ],
)
def test_goals_that_are_exclusive(clause: str, expected: list[str]) -> None:
    assert of("TLT0414", clause, before=APART) == expected
    assert of("TLT0414", clause, before=PLACES) == []
    assert of("TLT0410", clause, before=APART) == []


def test_the_compilers_warning_stays_where_it_says_something_else() -> None:
    assert of("TLT0410", "reach at(x) and at(y)", "reach at(z)", "avoid at(z)", before=APART) != []


@pytest.mark.parametrize(
    ("clauses", "before", "is_found"),
    [
        (("reach at(x)", "reach at(y)"), PLACES, True),
        (("reach at(x)", "reach at(y)"), APART, False),
        (("reach at(x) then at(y)",), PLACES, False),
        (("reach at(x) then at(y)", "reach at(z)"), APART, True),
        (("reach at(x) or at(y)",), PLACES, False),
        # Exclusive, these would be no farther from their goals.
        (("keep at(x)", "require N eventually at(y)"), PLACES, False),
        (("avoid next not at(x)", "require N at(x) until at(z)"), PLACES, False),
        (("reach at(x)", "reach d(y) < 3 m"), PLACES, False),
    ],
)
def test_goals_that_may_be_met_at_one_step(clauses: tuple[str, ...], before: str, is_found: bool) -> None:
    assert ("s" in of("TLT0415", *clauses, before=before)) == is_found


@pytest.mark.parametrize(
    "clauses",
    [
        ("reach at(x)", "keep at(y)"),
        ("reach at(x)", "require always at(y)"),
        ("reach at(x)", "require at(y) until at(x)"),
        ("reach at(x)", "require F (at(y) U at(x))"),
        ("reach at(x)", "reach at(y)", "keep at(x)"),
    ],
)
def test_what_is_kept_is_no_goal_beside_another(clauses: tuple[str, ...]) -> None:
    assert of("TLT0415", *clauses, before=PLACES) == []


def test_the_advice_to_exclude_never_makes_a_spec_impossible() -> None:
    for clauses in (
        ("reach at(x) and at(y)",),
        ("reach all e in (x, y): at(e)",),
        ("reach at(x) and at(y)", "reach at(z)"),
        ("reach at(x)", "reach at(y)", "reach at(x) and at(y)"),
        ("reach at(x) and at(y) and at(z)",),
    ):
        helps = [e.diagnostic.help for e in found(block(*clauses, before=PLACES)) if e.diagnostic.code == "TLT0415"]
        assert [text for text in helps if "exclusive" in (text or "")] == []
        assert [text for text in helps if " then " in (text or "")]


@pytest.mark.parametrize(
    "clauses",
    [
        # Between steps that are longer, the way from the start and the longest one stay as they are.
        ("reach at(x) then at(y)", "require G (at(z) -> F at(x))"),
        ("reach at(x)", "require X F at(z)"),
        ("reach at(x) then at(z)", "reach at(x) or at(y)"),
    ],
)
def test_nothing_is_said_where_exclusive_would_lengthen_nothing(clauses: tuple[str, ...]) -> None:
    assert of("TLT0415", *clauses, before=PLACES) == []


def test_atoms_of_different_predicates_are_not_said_to_exclude_each_other() -> None:
    before = PLACES + "signal seen(e): bool\n"
    helps = [
        each.diagnostic.help
        for each in found(block("reach at(x)", "reach at(y)", "reach seen(x)", "reach seen(y)", before=before))
        if each.diagnostic.code == "TLT0415"
    ]
    asked = [re.search("`exclusive (.*)`", text or "") for text in helps]
    assert [match and match[1] for match in asked] == ["at(x), at(y)", "seen(x), seen(y)"]


def test_exclusive_atoms_make_the_way_longer() -> None:
    """What the rule says of progress: with the declaration that it asks for, the spec has more steps."""
    clauses = ("reach at(x)", "reach at(y)")
    (joint,) = tltlc.compile_text(block(*clauses, before=PLACES))
    (apart,) = tltlc.compile_text(block(*clauses, before=APART))
    assert (joint.spec_size, apart.spec_size) == (1, 2)


# --- TLT0430, TLT0431 and TLT0432 -----------------------------------------------------------------


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("reach a", "keep x > 3 or x < 5"), ["keep x > 3 or x < 5"]),
        (("reach a", "avoid x > 5 and x < 3"), ["avoid x > 5 and x < 3"]),
        (("reach a", "avoid x > 5 and not x > 3"), ["avoid x > 5 and not x > 3"]),
        (("reach a", "require always (x > 5 implies x > 3)"), ["always (x > 5 implies x > 3)"]),
        (("reach a", "keep b or not b"), ["keep b or not b"]),
        (("reach a", "reach b or not b"), ["reach b or not b"]),
        (("reach a", "require b or not b"), ["b or not b"]),
        (("reach a", "avoid x + y > 15 and x < 4"), ["avoid x + y > 15 and x < 4"]),
        (("semantics infinite", "require G F a", "keep x > 3 or x < 5"), ["keep x > 3 or x < 5"]),
        (("reach a", "keep x > 5 or x < 3"), []),
        (("reach a", "keep x > 3 or x < 3"), []),
        (("reach a", "keep x > 3 or y < 5"), []),
        (("reach a", "avoid x + y > 13 and x < 4"), []),
        (("reach a", "avoid x > 3 and x < 5"), []),
        (("reach a", "keep b or not c"), []),
        # Of what the compiler says of the whole spec nothing more is said.
        (("reach b or not b",), []),
    ],
)
def test_clauses_that_nothing_breaks(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert of("TLT0430", *clauses, before=RANGES) == expected


def test_what_is_exclusive_cannot_be_broken() -> None:
    assert of("TLT0430", "reach at(z)", "avoid at(x) and at(y)", before=APART) == ["avoid at(x) and at(y)"]
    assert of("TLT0430", "reach at(z)", "avoid at(x) and at(y)", before=PLACES) == []


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("reach a", "keep x > 5", "avoid x > 3"), ["keep x > 5"]),
        (("reach a", "keep x > 5", "keep x < 3"), ["keep x > 5"]),
        (("reach x > 5 and x < 3",), ["reach x > 5 and x < 3"]),
        (("semantics infinite", "require G F (x > 5 & x < 3)"), ["G F (x > 5 & x < 3)"]),
        (("reach a", "keep x > 5", "avoid x > 7"), []),
        (("reach x > 5", "reach x < 3"), []),
        (("reach x > 5 then x < 3",), []),
        (("reach a", "keep x > 5", "keep y < 3"), []),
        (("reach a", "avoid a"), []),
    ],
)
def test_clauses_that_signals_set_apart(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert of("TLT0431", *clauses, before=RANGES) == expected


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("require always (at(x) implies at(y))", ["at(x) implies at(y)"]),
        ("keep at(x) implies at(y)", ["at(x) implies at(y)"]),
        ("keep d(x) > 5 m implies d(x) < 2 m", ["d(x) > 5 m implies d(x) < 2 m"]),
        ("require always (at(x) implies eventually at(y))", []),
        ("require always (at(x) implies not at(y))", []),
        ("require always (at(x) implies at(z))", []),
        ("keep d(x) > 5 m implies d(x) > 2 m", []),
        ("keep at(x) implies false", []),
        ("require not (at(x) implies at(y))", []),
        ("require F (at(x) implies at(y))", []),
    ],
)
def test_implications_that_are_never_answered(clause: str, expected: list[str]) -> None:
    assert of("TLT0432", "reach at(z)", clause, before=APART) == expected


def test_an_implication_is_told_in_place_of_the_contradiction_that_it_makes() -> None:
    text = block("reach at(x)", "reach at(z)", "require always (at(x) implies at(y))", before=APART)
    assert [code for code in codes(text) if code != "TLT0415"] == ["TLT0432"]


ENDS = st.integers(1, 9)


@given(ENDS, ENDS, st.sampled_from("<>"), st.sampled_from("<>"), st.sampled_from(["and", "or"]))
def test_relations_are_those_of_numbers(one: int, two: int, first: str, second: str, op: str) -> None:
    """A comparison of both ends with all values in steps of a half decides what the rule proves."""
    values = [step / 2 for step in range(21)]
    truths = {(x < one if first == "<" else x > one, x < two if second == "<" else x > two) for x in values}
    met = [any(truth) if op == "or" else all(truth) for truth in truths]
    assume(f"x {first} {one}" != f"x {second} {two}")
    clause = f"x {first} {one} {op} x {second} {two}"
    assert bool(of("TLT0430", "reach a", f"keep {clause}", before=RANGES)) == all(met)
    assert bool(of("TLT0431", "reach a", f"reach {clause}", before=RANGES)) == (not any(met))


# --- TLT0416 and TLT0417 --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("predicate", "expected"),
    [
        ("[0, 1] = x / 10", []),
        ("[-1, 0] = -x / 10", ["never"]),
        ("[-1, 0] = x / 10 - 1", ["never"]),
        ("[-1, 1] = x / 10 - 0.5", []),
        ("[0, 1] = (x + 1) / 11", ["always"]),
        ("[-1, 1] = when x > 5: -0.5 otherwise: -1", ["never"]),
        ("[-1, 1] = when x > 5: 0.5 otherwise: -1", []),
        ("[-1, 1] = when x > 11: 1 otherwise: -1", ["never"]),
        ("[-1, 1] = when x >= 10: 1 otherwise: -1", []),
        ("[0, 1] = (x / 10)^2", []),
        ("[-1, 0] = -(x / 10)^2", ["never"]),
        ("[-1, 1] = min(x / 10 - 0.5, 0.5 - x / 10)", ["never"]),
    ],
)
def test_atoms_with_one_truth(predicate: str, expected: list[str]) -> None:
    before = f"signal x in [0, 10]\npredicate p in {predicate}\n"
    titles = [e.diagnostic.title for e in found(block("reach p", before=before)) if e.diagnostic.code == "TLT0416"]
    assert titles == [f"`p` {each} holds" for each in expected]


def test_an_atom_is_named_once_in_a_file() -> None:
    before = "signal x in [0, 10]\npredicate p in [-1, 0] = -x / 10\n"
    assert codes(before + "spec one = F p\nspec two = G !p\n") == ["TLT0416"]


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        (("reach alive",), ["alive"]),
        (("reach a then alive",), ["alive"]),
        (("keep alive",), []),
        (("reach a", "keep alive"), []),
        (("reach not alive",), []),
        (("reach a and alive",), ["alive"]),
    ],
)
def test_goals_without_a_slope(clauses: tuple[str, ...], expected: list[str]) -> None:
    assert of("TLT0417", *clauses, before="import stealth\nsignal a: bool\n") == expected


# --- the form of a spec ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("require X X a", ["X X"]),
        ("require X F a", []),
        ("require X a", []),
        ("require next after 2 steps a", ["next after 2 steps"]),
        ("require next after 1 step a", []),
        ("require next after 2 s a", []),
        ("require N (N a)", ["N (N"]),
        ("require X (a and X b)", []),
        ("reach a then b then c", []),
    ],
)
def test_nexts_that_count(clause: str, expected: list[str]) -> None:
    assert [each.rstrip() for each in of("TLT0418", clause, before="clock 10 Hz\n" + SIGNALS)] == expected


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("keep eventually a", ["keep eventually"]),
        ("keep (F (a))", ["keep (F"]),
        ("require G F a", ["G F"]),
        ("require b -> [] <> a", ["[] <>"]),
        ("require F (G a)", ["F (G"]),
        ("reach always a", ["reach always"]),
        ("keep b and eventually a", ["eventually"]),
        ("require always (b and eventually a)", ["eventually"]),
        ("require F (b or G a)", ["G"]),
        ("require F (b and G a)", []),
        ("require G (b or F a)", []),
        ("avoid always a", ["avoid always"]),
        ("avoid b or always a", ["always"]),
        ("avoid b and always a", []),
        ("avoid eventually a", []),
        ("require G not G a", ["G not G"]),
        ("reach b then (always a)", ["always"]),
        ("reach b then (always a) then c", []),
        ("keep a until b", ["keep a until"]),
        ("require a until b", []),
        ("require G F[0,3] a", []),
        ("require G (a -> F b)", []),
        ("keep a", []),
        ("reach a", []),
    ],
)
def test_what_speaks_of_the_last_step(clause: str, expected: list[str]) -> None:
    assert of("TLT0424", clause) == expected
    assert of("TLT0424", clause, "semantics infinite") == []


def test_a_good_clause_is_not_blamed_for_one_that_speaks_of_the_last_step() -> None:
    before = "signal a: bool signal b: bool\n"
    assert codes(block("reach a", "keep b until a", before=before)) == ["TLT0424"]
    assert codes(block("reach a", "require b until a", before=before)) == ["TLT0413"]


@settings(deadline=None)
@given(st.sampled_from(["keep", "avoid", "reach", "require G", "require F"]), SMALL)
def test_what_speaks_of_the_last_step_can_be_said_of_it_alone(clause: str, formula: str) -> None:
    """Where the rule speaks of a whole clause, the automaton looks at the last sample of a trace and at no other."""
    text = block(f"{clause} ({formula})")
    (spec,) = compile_source(SourceFile("example.tltl", text)).program.specs
    labels = [each.diagnostic.labels[0] for each in found(text) if each.diagnostic.code == "TLT0424"]
    start = text.index(clause)
    for label in labels:
        if label.span.start != start or " U " in formula:
            continue
        message = label.message
        last = message[message.index("`") + 1 : message.rindex("`")]
        (same,) = tltlc.compile_text(f"{SIGNALS}spec t = F ((N false) & ({last}))")
        assert are_equivalent(build(spec), same)


def test_what_is_said_of_all_entities_is_said_once() -> None:
    assert of("TLT0424", "require all e in (x, y): G F at(e)", before=PLACES) == ["G F"]
    assert of("TLT0412", "require all e in (x, y): F (at(z) -> at(e))", before=PLACES) == ["at(z) -> at(e)"]


def test_lets_are_looked_at_where_all_specs_are_finite() -> None:
    text = "signal a: bool let often = G F a spec s = often"
    assert marked(text, "TLT0424") == ["G F"]
    assert codes(f"{text} spec t {{ semantics infinite limit 9 steps judge at limit require often }}") == []
    assert codes("signal a: bool let often = G F a") == []


def test_what_speaks_of_the_first_step() -> None:
    assert of("TLT0429", "require a and not b") == ["require a and not b"]
    assert of("TLT0429", "require a implies F b", "require true", "keep a", "require X a") == []
    assert "TLT0429" not in codes(f"{SIGNALS}spec s = a")


@pytest.mark.parametrize(
    ("formula", "expected", "way_out"),
    [
        ("eventually a and b", ["b"], "eventually (a and b)"),
        ("F a & b & (a or c) & G c", ["b & (a or c)"], "F (a and b and (a or c))"),
        ("always a until b and c", [], ""),
        ("eventually within 3 steps a and b", ["b"], "eventually within 3 steps (a and b)"),
        ("c and always a and b", ["b"], "always (a and b)"),
        ("a and eventually b", [], ""),
        ("eventually (a) and b", [], ""),
        ("(eventually a) and b", [], ""),
        ("eventually a and next b", [], ""),
        ("eventually a and b until c", [], ""),
    ],
)
def test_what_stands_behind_a_temporal_word_and_is_outside_of_it(
    formula: str, expected: list[str], way_out: str
) -> None:
    assert of("TLT0429", f"require {formula}") == expected
    told = [each.diagnostic for each in found(f"{SIGNALS}spec s = {formula}") if each.diagnostic.code == "TLT0429"]
    assert [each.help for each in told] == [f"both together are `{way_out}`" for _ in expected]
    for each in told:
        # What is shown is another formula, which compiles.
        ours, theirs = tltlc.compile_text(f"{SIGNALS}spec s = {formula}\nspec t = {way_out}")
        assert each.severity == "note" and not are_equivalent(ours, theirs)


def test_a_spec_that_is_one_formula_needs_no_limit() -> None:
    assert codes(SIGNALS + "spec s = F (a & b & c)") == []
    assert codes(SIGNALS + "spec s { require F (a & b & c) }") == ["TLT0419"]


@pytest.mark.parametrize(
    ("clauses", "is_found"),
    [
        ("reach a", False),
        ("avoid a", True),
        ("judge at limit avoid a", False),
        ("require G (a -> F b)", True),
        ("semantics infinite require G (a -> F b)", True),
        ("semantics infinite require G F a", False),
        ("semantics infinite reach a require G F b", False),
    ],
)
def test_nothing_to_reach(clauses: str, is_found: bool) -> None:
    text = f"signal a: bool signal b: bool let both = a & b\nspec s {{ limit 9 steps {clauses} }}"
    assert ("TLT0420" in codes(text)) == is_found


@pytest.mark.parametrize(
    ("clauses", "is_found"),
    [
        ("limit 2 steps reach a then b", False),
        ("limit 1 step reach a then b", True),
        ("limit 2 steps require F[3,5] a", True),
        ("limit 3 steps keep a", False),
    ],
)
def test_limits_that_are_too_short(clauses: str, is_found: bool) -> None:
    assert ("TLT0428" in codes(f"{SIGNALS}spec s {{ {clauses} }}")) == is_found


# --- declarations ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        "signal a: bool\nlet both(x) = a & x\n",  # a library
        "import spatial\nsignal position.x: length in [0 m, 9 m]\nspec s = F inside_rectangle(1 m, 2 m, 3 m, 4 m)",
        "param far: length = 3 m\nimport spatial\nentity e\nspec s = F near(e, far = far)",
        "entity e, f\nsignal a(x: entity): bool\nspec s = all x in (e, f): F a(x)",
        "entity e\nsignal a(x: entity): bool\nexclusive a(e), b\nsignal b: bool\nspec s = F b & F c\nsignal c: bool",
        "import stealth as st\nspec s = G st.alive",
        "import stealth (alive)\nspec s = G alive",
        "signal x: length in [0 m, 9 m]\nparam most: length in [1 m, 4 m] = 3 m\nspec s = F x > most",
    ],
)
def test_what_is_used(text: str) -> None:
    assert not {"TLT0421", "TLT0422"}.intersection(codes(text))


def test_what_is_used_by_what_is_not_used_goes_with_the_next_look() -> None:
    text = "signal a: bool\nsignal b: bool\nlet c = F b\nspec s = F a\n"
    assert marked(text, "TLT0421") == ["c"]


def test_an_import_may_count_without_being_named(tmp_path, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rules.tltl").write_text("clock 10 Hz\n")
    (tmp_path / "idle.tltl").write_text("signal z: bool\n")
    assert codes("import rules\nimport idle\nsignal a: bool\nspec s { limit 3 s reach a }") == ["TLT0422"]


def test_a_level_or_a_tag_of_the_same_name_is_no_use() -> None:
    text = block("level vault", "tag quick", "reach a", before="signal vault: bool signal quick: bool signal a: bool\n")
    assert marked(text, "TLT0421") == ["vault", "quick"]


# --- specs beside each other ----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("one", "other", "is_found"),
    [
        ("F (a & X F b)", "a then b", True),
        ("F a", "F (a | a & b)", True),
        ("F a", "F b", False),
        ("G a", "!F !a", True),
        ("a U b", "b R a", False),
    ],
)
def test_specs_that_ask_for_the_same(one: str, other: str, is_found: bool) -> None:
    assert ("TLT0426" in codes(f"{SIGNALS}spec s = {one}\nspec t = {other}")) == is_found


@given(SMALL, SMALL)
def test_specs_are_the_same_where_their_automata_accept_the_same(one: str, other: str) -> None:
    written = tltlc.compile_text(f"{SIGNALS}spec s = {one}")[0]
    label = written.states[0].label.ascii
    # The label says the same in other words; the order of atoms is to make no difference.
    for again in (other, label, f"(c | !c) & (({label}) & (b | !b))"):
        ours, theirs = tltlc.compile_text(f"{SIGNALS}spec s = {one}\nspec t = {again}")
        is_same = ours.judge == theirs.judge and are_equivalent(ours, theirs)
        assert ("TLT0426" in codes(f"{SIGNALS}spec s = {one}\nspec t = {again}")) == is_same


def test_a_third_spec_is_told_once() -> None:
    assert codes("signal a: bool spec s = F a spec t = F a spec u = F a").count("TLT0426") == 2


def test_other_limits_make_other_specs() -> None:
    text = "signal a: bool spec s { limit 9 steps reach a } spec t { limit 19 steps reach a }"
    assert codes(text) == []


@pytest.mark.parametrize(
    "formula",
    [
        " -> ".join(["a"] * 900),
        " U ".join(["a"] * 900),
        "F " * 990 + "a",
        "X " * 900 + "a",
        "F (" + "!" * 900 + "a -> b)",
    ],
    ids=lambda formula: formula[:6],
)
def test_long_formulas_are_linted(formula: str) -> None:
    assert set(codes(f"signal a: bool signal b: bool let both = a & b spec x = {formula}")) >= {"TLT0421"}
