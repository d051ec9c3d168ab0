"""English sentences of formulas: known examples, and properties of all sentences."""

from __future__ import annotations

from collections import defaultdict

import pytest
from hypothesis import assume, given

from tests.logic.small_formulas import formulas_of_size, formulas_up_to
from tests.logic.strategies import formulas
from tests.logic.truth_table import TruthTable
from tests.reference_formulas import corpus, read_formula
from tltlc.core.names import ComparisonName
from tltlc.logic import formula as f
from tltlc.logic.formula import FALSE, TRUE, Formula
from tltlc.logic.rewrite import simplify
from tltlc.logic.text.printer import english_text

EXAMPLES = {
    "true": "Nothing remains to be done.",
    "false": "The spec is violated.",
    "a": "Have a now.",
    "!a": "Avoid a now.",
    "F(near(s1) & X F(near(s2) & X F near(exit))) & G alive": (
        "Reach near(s1), then near(s2), then near(exit), and keep alive throughout."
    ),
    "F near(exit) & G alive & G !seen": "Reach near(exit), keep alive throughout, and avoid seen throughout.",
    "G(alive & !seen)": "Keep alive throughout, and avoid seen throughout.",
    "G(a | !b) & F c": "Keep a or not b throughout, and reach c.",
    "G !(a & b)": "Avoid (a and b) throughout.",
    "G(a -> b)": "Whenever a, have b at that step.",
    "G(a -> X F b)": "Whenever a, at the next step, reach b at that step or later.",
    "G(a -> X(b & X c))": "Whenever a, at the next step, (have b at that step, and have c at the next step).",
    "G(a & b)": "Keep a and b throughout.",
    "F(s3 & X F(o & e | p & f)) & G alive": "Reach s3, then (o and e) or (p and f), and keep alive throughout.",
    "F(c1 & X F e1 | c2 & X F e2) & G p": "Reach either (c1, then e1) or (c2, then e2), and keep p throughout.",
    "F(a & F b)": "Reach a, then or at the same time b.",
    "F(a & X F(b & G c))": "Reach a, then b and from that step on keep c throughout.",
    "F(a & X(b | X(b | X b)))": "Reach a, then b within 3 steps after a.",
    "F((a | b) & X(c | X c))": "Reach a or b, then c within 2 steps after (a or b).",
    "F(a & X(b & X(c | X c) | X(b & X(c | X c))))": (
        "Reach a, then b within 2 steps after a, then c within 2 steps after b."
    ),
    "F a & F b & F c": "Reach a, reach b, and reach c.",
    "G(a -> F b)": "Whenever a, reach b at that step or later.",
    "G(!a | F b)": "Whenever a, reach b at that step or later.",
    "G(a -> X b) & b": "Whenever a, have b at the next step; and have b now.",
    "!F a": "Avoid a throughout.",
    "G F a": "At every step, reach a at that step or later.",
    "G G a": "Keep a throughout.",
    "G G G(a -> F b)": "Whenever a, reach b at that step or later.",
    "G !F(a & X F b)": "Whenever a, avoid b from the next step on.",
    "!F[0,3] a": "Avoid a for 4 steps.",
    "!G[0,3] !a": "Reach a within 3 steps.",
    "F !G[0,3] a": "Reach a step that begins this: reach not a within 3 steps.",
    "X F[0,3] a": "Reach a within the next 4 steps.",
    "N G[0,3] a": "Keep a for the next 4 steps.",
    "X G[0,3] a": "At the next step, keep a for 4 steps.",
    "G !F(a & X F[0,3] b)": "Whenever a, avoid b for the next 4 steps.",
    "G(G a & N G b)": "Keep a throughout; and at every step, keep b from the next step on.",
    "F G a": "From some step on keep a throughout.",
    "!G F a": "From some step on avoid a throughout.",
    "F G(a & !b) & c": "From some step on (keep a throughout, and avoid b throughout), and have c now.",
    "!F(a & X F(b & X F c))": "Avoid the sequence (a, then b, then c) throughout.",
    "G(!a | N G(!b | N G !c))": "Avoid the sequence (a, then b, then c) throughout.",
    "G(a -> N G(b -> c))": "Whenever a, from the next step on, whenever b, have c at that step.",
    "G(a -> F[0,2] b & c)": "Whenever a, (have c at that step, and reach b within 2 steps).",
    "G(a -> F b | c)": "Whenever a, either have c at that step or reach b at that step or later.",
    "F[0,3] (a & b)": "Reach (a and b) within 3 steps.",
    "F(a & X(b & c | X(b & c)))": "Reach a, then (b and c) within 2 steps after a.",
    "F(a & X F b) & G c & G !d": "Reach a, then b; keep c throughout; and avoid d throughout.",
    "F near(s1, 2) & F near(s2, 2)": "Reach near(s1, 2), and reach near(s2, 2).",
    "F(a & X F b) & F(c & X F d)": "Reach a, then b; and reach c, then d.",
    "G(!a | b)": "Avoid (a and not b) throughout.",
    "a & N G(!a | !b)": "Have a now, and avoid (a and b) from the next step on.",
    "F(a & X G b)": "Reach a and from that step on (at the next step, keep b throughout).",
    "!b U a": "Reach a, avoiding b until then.",
    "!b W a": "Avoid b until the first step with a, or throughout if there is none.",
    "a R b": "Keep b up to and including the first step with a, or throughout if there is none.",
    "a M b": "Reach a, keeping b up to and including that step.",
    "a | X(a | X a)": "Reach a within 2 steps.",
    "a & N(a & N a)": "Keep a for 3 steps.",
    "a & X b | X(a & X b)": (
        "Reach within 1 step a step that begins this: (have a at that step, and have b at the next step)."
    ),
    "X X X a": "Have a after 3 steps.",
    "N a": "Have a at the next step, if there is one.",
    "!X X X a": "Avoid a after 3 steps, if the play goes on for that long.",
    "X X G a": "After 2 steps, keep a throughout.",
    "X true": "The play must not end at this step.",
    "X X true": "The play must go on for at least 2 more steps.",
    "N false": "The play must end at this step.",
    "N N false": "The play must end at most 1 step later.",
    "!X true": "The play must end at this step.",
    "N false | F a": "Either (the play must end at this step) or reach a.",
    "F X true": "Reach a step that is not the last.",
    "F(a & N false)": "Reach a at a step that is the last.",
    "G(a -> X true)": "Whenever a, the play must not end at that step.",
    "a U N false": "Reach a step that is the last, keeping a until then.",
    "true U a": "Reach a.",
    "false U a": "Have a now.",
    "a U true": "Nothing remains to be done.",
    "a U false": "The spec is violated.",
    "a W false": "Keep a throughout.",
    "false R a & F b": "Keep a throughout, and reach b.",
    "true R a": "Have a now.",
    "a M true": "Reach a.",
    "true M a": "Have a now.",
    "!(true U a)": "Avoid a throughout.",
    "G(true U a)": "At every step, reach a at that step or later.",
    "F(true & X F b)": "At the next step, reach b at that step or later.",
    "F a -> false": "Avoid a throughout.",
    "a -> F b": "If a now, reach b.",
    "F a -> F b": "Either avoid a throughout or reach b.",
    "F a <-> G b": "Do both or neither of these: reach a, keep b throughout.",
}

ENDLESS = {
    "G F a": "Reach a again and again.",
    "G G F a": "Reach a again and again.",
    "!F G a": "Reach not a again and again.",
    "G(F a & F !b)": "Reach a again and again, and reach not b again and again.",
    "G F(a | b) & F G c": "Reach a or b again and again, and from some step on keep c throughout.",
    "G F(a & X F b)": "Again and again, reach a, then b.",
    "G F G a": "Again and again, from some step on keep a throughout.",
    "F(c & G F a)": "Reach c and from that step on reach a again and again.",
    "G(a -> G F b)": "Whenever a, reach b again and again.",
    "G(a -> F b)": "Whenever a, reach b at that step or later.",
    "G F a -> G F b": "Either (from some step on avoid a throughout) or reach b again and again.",
    "F b & (F G !c | G F d)": (
        "Reach b; and either (from some step on avoid c throughout) or reach d again and again."
    ),
    "N a": "Have a at the next step.",
    "!X a": "Avoid a at the next step.",
    "X N N a": "Have a after 3 steps.",
    "N G a": "At the next step, keep a throughout.",
    "G(a -> N b)": "Whenever a, have b at the next step.",
    "a & N(a & N a)": "Keep a for 3 steps.",
    "true": "Nothing remains to be done.",
    "false": "The spec is violated.",
}
"""Sentences over infinite traces."""


@pytest.mark.parametrize(("formula", "sentence"), EXAMPLES.items())
def test_formulas_print_as_known_sentences(formula: str, sentence: str) -> None:
    assert english_text(read_formula(formula)) == sentence


def test_negated_comparisons_are_reversed_and_need_no_brackets() -> None:
    low, high = f.not_(f.atom(ComparisonName("fuel", ">", "5"))), f.atom(ComparisonName("near(a)", "<", "3"))
    assert english_text(f.always(f.or_(low, high))) == "Keep fuel <= 5 or near(a) < 3 throughout."
    assert english_text(f.always(low)) == "Keep fuel <= 5 throughout."
    assert english_text(f.eventually(f.and_(f.not_(high), f.atom("p")))) == "Reach near(a) >= 3 and p."


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        (ComparisonName("previous(fuel)", ">", "fuel"), "Keep fuel < previous(fuel) throughout."),
        (ComparisonName("distance(guard2)", ">", "2"), "Keep distance(guard2) > 2 throughout."),
        (ComparisonName("distance(exit)", "<", "close"), "Keep distance(exit) < close throughout."),
        (ComparisonName("previous(near(a))", ">", "near(a)"), "Keep near(a) < previous(near(a)) throughout."),
        (ComparisonName("fuel", "<", "coins"), "Keep fuel < coins throughout."),
    ],
)
def test_a_signal_stands_before_a_value_of_its_own(name: ComparisonName, sentence: str) -> None:
    assert english_text(f.always(f.atom(name))) == sentence


def test_clauses_that_nest_too_deeply_have_no_signs() -> None:
    text = "c"
    for number in range(9):
        text = f"a & X(!{'bd'[number % 2]} U ({text}))"
    sentence = english_text(read_formula(text))
    assert "satisfy" in sentence
    assert not set(sentence) & set("!&|")


@pytest.mark.parametrize(("formula", "sentence"), ENDLESS.items())
def test_formulas_over_infinite_traces_print_as_known_sentences(formula: str, sentence: str) -> None:
    assert english_text(read_formula(formula), endless=True) == sentence


@given(formulas(max_leaves=20))
def test_every_formula_has_a_sentence_that_names_its_atoms(formula: Formula) -> None:
    assert_sentence(english_text(formula))


@given(formulas(max_leaves=20))
def test_constants_are_never_named(formula: Formula) -> None:
    text = english_text(formula)
    assume("atisfy" not in text)  # a part that is nested too deeply for a sentence is written as a formula
    words = text.rstrip(".").replace("(", " ").replace(")", " ").replace(",", " ").split()
    assert not {"true", "false"}.intersection(words)


def test_the_corpus_has_sentences() -> None:
    for entry in corpus():
        text = english_text(entry.formula)
        assert_sentence(text)
        says_all = not any(TRUE in node.args or FALSE in node.args for node in entry.formula.walk())
        named = entry.formula if says_all else simplify(entry.formula)
        assert all(name in text for name in named.atoms())


def assert_sentence(text: str) -> None:
    assert text[0].isupper()
    assert text.endswith(".")
    assert text.count("\n") == 0
    assert "  " not in text
    assert text.count("(") == text.count(")")


@pytest.mark.parametrize("part", [pytest.param(1, marks=pytest.mark.slow), 5])
def test_a_sentence_has_one_meaning(part: int) -> None:
    """Small formulas with the same sentence agree on all traces."""
    table = TruthTable("ab", 4)
    meanings: dict[str, dict[tuple[int, ...], Formula]] = defaultdict(dict)
    for formula in (*formulas_up_to(4), *formulas_of_size(5)[:: 2 * part], *formulas_of_size(6)[:: 49 * part]):
        meanings[english_text(formula)].setdefault(table.of(formula), formula)
    ambiguous = {
        text: [str(x) for x in formulas_by_truth.values()]
        for text, formulas_by_truth in meanings.items()
        if len(formulas_by_truth) > 1
    }
    assert not ambiguous


@pytest.mark.parametrize(
    "nest",
    [
        f.not_,
        f.next_,
        f.eventually,
        lambda inner: f.then(f.atom("p"), inner),
        lambda inner: f.until(inner, f.atom("p")),
        lambda inner: f.implies(f.atom("p"), f.next_(inner)),
        lambda inner: f.and_(f.atom("q"), f.or_(f.atom("p"), inner)),
    ],
    ids=["not", "X", "F", "then", "U", "->", "and or"],
)
def test_deep_formulas_have_sentences(nest: object) -> None:
    assert callable(nest)
    formula = f.always(f.atom("a"))
    for _ in range(10_000):
        formula = nest(formula)
    assert_sentence(english_text(formula))
