"""Automata for property tests of the backends: real ones, and ones with hostile names and texts."""

from __future__ import annotations

from hypothesis import strategies as st

from tests.fixtures import cover_and_hide
from tests.logic.strategies import formulas
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa, Guard, Text
from tltlc.automaton.infinite.build import build_infinite
from tltlc.core.record import replace
from tltlc.expression.tree import Condition, Const, Expression, Op, ParamValue, SignalValue, When
from tltlc.logic.text.parser import FormulaParser
from tltlc.resolve import spec

HOSTILE = (
    'quote " in it',
    "apostrophe ' in it",
    "back\\slash\\",
    "new\nline\r\n",
    "*/ end of comment /*",
    '"""; import os; """',
    "'''",
    "</script><script>alert(1)</script>",
    "<!-- -->",
    "]]> <![CDATA[",
    "%% comment",
    "\u202egnihton\u202c",
    "{braces} {{double}} ${dollar}",
    "[square] ]; }",
    "&amp; & &lt; #38; #quot;",
    "<b>bold</b> <br/>",
    "semi;colon: -->",
    "\x00\x07\x1b[31m\x7f",
    "\u2028\u2029\u200b\ufeff",
    "𝒰 ∧ ◇ é 漢",
    "\\N \\G \\l",
    "trailing\\",
    "direction LR",
    "   ",
)

hostile_texts = st.sampled_from(HOSTILE) | st.text(st.characters(exclude_categories=("Cs",)), max_size=12)

EXCLUSIVE = (("a", "b"), ("a", "b", "c"), ("b", "c"))


def automata() -> st.SearchStrategy[Fspa]:
    """Automata of random formulas over a, b, c, some with exclusive atoms."""
    groups = st.lists(st.sampled_from(EXCLUSIVE), max_size=2, unique=True)
    specs = st.builds(
        lambda formula, exclusive: spec_from_formula(
            formula, exclusive=[group for group in exclusive if set(group) <= set(formula.atoms())]
        ),
        formulas(max_leaves=6),
        groups,
    )
    return specs.map(build)


def infinite_automata() -> st.SearchStrategy[Fspa]:
    """Automata over infinite traces, some with parallel edges that differ only in their acceptance pairs."""
    specs = st.builds(
        lambda formula, exclusive: replace(
            spec_from_formula(formula, exclusive=[group for group in exclusive if set(group) <= set(formula.atoms())]),
            semantics="infinite",
        ),
        formulas(max_leaves=5),
        st.lists(st.sampled_from(EXCLUSIVE), max_size=1),
    )
    return specs.map(build_infinite)


def finite() -> st.SearchStrategy[float]:
    return st.floats(allow_nan=False, allow_infinity=False)


def expressions() -> st.SearchStrategy[Expression]:
    """Expressions with every operator, over the signals and the parameter of the Cover and Hide fixture."""
    leaves = st.one_of(
        st.builds(Const, finite()),
        st.sampled_from([SignalValue("distance(s1)"), SignalValue("health"), ParamValue("level_size")]),
    )
    return st.recursive(leaves, _operations, max_leaves=10)


def _operations(inner: st.SearchStrategy[Expression]) -> st.SearchStrategy[Expression]:
    def op(names: str, low: int, high: int) -> st.SearchStrategy[Expression]:
        return st.builds(Op, st.sampled_from(names.split()), st.lists(inner, min_size=low, max_size=high).map(tuple))

    comparisons = st.builds(Condition, st.sampled_from(["<", "<=", ">", ">="]), st.tuples(inner, inner))
    conditions = st.one_of(
        comparisons,
        st.builds(Condition, st.sampled_from(["and", "or"]), st.tuples(comparisons, comparisons)),
        st.builds(Condition, st.just("not"), st.tuples(comparisons)),
    )
    cases = st.lists(st.tuples(conditions, inner), min_size=1, max_size=2).map(tuple)
    return st.one_of(
        op("+ - * / ^", 2, 2),
        op("neg abs sqrt exp tanh", 1, 1),
        op("min max", 2, 3),
        op("clamp", 3, 3),
        st.builds(When, cases, inner),
    )


@st.composite
def hostile_automata(draw: st.DrawFn) -> Fspa:
    """The Cover and Hide automaton with hostile texts in every place that a spec or an artefact can fill."""
    fspa = cover_and_hide()
    names = draw(st.lists(hostile_texts.filter(bool), min_size=4, max_size=4, unique=True))
    parser = FormulaParser(names)
    no_formulas = hostile_texts.filter(lambda text: parser.formula(text) is None)
    text = st.builds(Text, no_formulas, hostile_texts, hostile_texts)
    states = tuple(replace(state, label=draw(text)) for state in fspa.states)
    guards = no_formulas.map(lambda text: Text(text, text, text))
    edges = tuple(replace(edge, guard=Guard(draw(guards), edge.guard.primes)) for edge in fspa.edges)
    signal = draw(hostile_texts.filter(lambda name: bool(name) and name != "health"))
    return replace(
        fspa,
        doc=draw(hostile_texts),
        formula=draw(text),
        level=draw(hostile_texts),
        tags=(draw(hostile_texts),),
        signals=(spec.Signal(signal, "number", -1.0, 1.0, draw(hostile_texts)), fspa.signals[3]),
        params=(spec.Param(draw(hostile_texts.filter(bool)), "number", 1.0, None, None, draw(hostile_texts)),),
        atoms=tuple(spec.Atom(name, SignalValue(signal), draw(hostile_texts)) for name in names),
        states=states,
        edges=edges,
    )
