"""Build the nodes of the syntax tree: one method per rule of the grammar, with the rule's name."""

# ruff: noqa: D102 (a method's name is the name of its rule in tltl.lark, which documents it)

from __future__ import annotations

from math import inf, isinf

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.grammar import tree
from tltlc.grammar.keywords import TEST_ITEMS
from tltlc.grammar.lexer import Token
from tltlc.grammar.tree import Expr

OPERATORS = {
    "NOT": "not",
    "AND": "and",
    "OR": "or",
    "IMPLIES": "implies",
    "IFF": "iff",
    "EVENTUALLY": "F",
    "ALWAYS": "G",
    "NEXT": "X",
    "WEAK_NEXT": "N",
    "UNTIL": "U",
    "WEAK_UNTIL": "W",
    "RELEASE": "R",
    "STRONG_RELEASE": "M",
    "ONCE": "once",
    "HISTORICALLY": "historically",
    "PREVIOUSLY": "previously",
    "BEGINS": "begins",
    "ENDS": "ends",
    "THEN": "then",
    "LESS": "<",
    "AT_MOST": "<=",
    "MORE": ">",
    "AT_LEAST": ">=",
    "EQUALS": "==",
    "UNEQUAL": "!=",
    "PLUS": "+",
    "MINUS": "-",
    "TIMES_SIGN": "*",
    "DIVIDE": "/",
    "POWER": "^",
}
"""Maps the terminal of each operator to the spelling under which the tree stores the operator."""

MOST_REPETITIONS = 100_000
"""The most times that a test may repeat a step, as in ``step 3x alive``."""
_EXPECT_HELP = f"the form is {TEST_ITEMS['expect']}"


class Builder:
    """Builds the syntax tree of one file, and collects errors in ``diagnostics``.

    The parser calls the method ``make_NAME`` when it has read the rule NAME of the grammar. Each method
    takes the span of the text that the rule matched, then the values of the rule's parts: tokens, and
    what the methods of other rules returned. The value of an absent optional part is None.
    """

    def __init__(self, source: SourceFile, docs: dict[int, str]) -> None:
        self.diagnostics: list[Diagnostic] = []
        self._source = source
        self._docs = docs

    def make_module(self, _span: Span, *declarations: tree.Declaration) -> tuple[tree.Declaration, ...]:
        return declarations

    # --- declarations ---------------------------------------------------------------------------

    def make_import(self, span: Span, target: Token, rest: tuple[tree.NameExpr, ...] | str | None) -> tree.Import:
        is_path = target.type == "STRING"
        text = target.text[1:-1] if is_path else target.text
        names = rest if isinstance(rest, tuple) else None
        return tree.Import(text, is_path, names, rest if isinstance(rest, str) else None, target.span, span)

    def make_import_names(self, _span: Span, names: tuple[tree.NameExpr, ...]) -> tuple[tree.NameExpr, ...]:
        return names

    def make_import_alias(self, _span: Span, _as: Token, name: Token) -> str:
        return name.text

    def make_signal(
        self,
        span: Span,
        name: Token,
        parameters: tuple[tree.Parameter, ...] | None,
        type_: str | None,
        interval: tree.Interval | None,
    ) -> tree.SignalDecl:
        return tree.SignalDecl(name.text, parameters or (), type_, interval, self._doc(span), name.span, span)

    def make_untyped_signal(
        self, span: Span, name: Token, parameters: tuple[tree.Parameter, ...] | None, interval: tree.Interval
    ) -> tree.SignalDecl:
        return self.make_signal(span, name, parameters, None, interval)

    def make_enum_signal(
        self, span: Span, name: Token, parameters: tuple[tree.Parameter, ...] | None, values: tuple[tree.NameExpr, ...]
    ) -> tree.SignalDecl:
        return replace(self.make_signal(span, name, parameters, "int", None), values=values)

    def make_entities(self, span: Span, _entity: Token, names: tuple[tree.NameExpr, ...]) -> tree.EntityDecl:
        return tree.EntityDecl(names, self._doc(span), span)

    def make_group_decl(
        self, span: Span, _entity: Token, name: Token, members: tuple[tree.NameExpr, ...]
    ) -> tree.GroupDecl:
        return tree.GroupDecl(name.text, members, self._doc(span), name.span, span)

    def make_param(
        self, span: Span, name: Token, type_: str | None, interval: tree.Interval | None, value: Expr
    ) -> tree.ParamDecl:
        return tree.ParamDecl(name.text, type_, interval, value, self._doc(span), name.span, span)

    def make_clock(self, span: Span, value: tree.NumberExpr) -> tree.ClockDecl:
        return tree.ClockDecl(value, span)

    def make_varying_clock(self, span: Span, _varies: Token) -> tree.ClockDecl:
        return tree.ClockDecl(None, span)

    def make_predicate(
        self,
        span: Span,
        name: Token,
        parameters: tuple[tree.Parameter, ...] | None,
        interval: tree.Interval | None,
        body: Expr,
    ) -> tree.PredicateDecl:
        return tree.PredicateDecl(name.text, parameters or (), interval, body, self._doc(span), name.span, span)

    def make_let(
        self, span: Span, name: Token, parameters: tuple[tree.Parameter, ...] | None, body: Expr
    ) -> tree.LetDecl:
        return tree.LetDecl(name.text, parameters or (), body, self._doc(span), name.span, span)

    def make_exclusive(self, span: Span, atoms: tuple[Expr, ...]) -> tree.ExclusiveDecl:
        return tree.ExclusiveDecl(atoms, span)

    def make_parameters(self, _span: Span, *parameters: tree.Parameter) -> tuple[tree.Parameter, ...]:
        return parameters

    def make_parameter(self, span: Span, name: Token, type_: str | None, default: Expr | None) -> tree.Parameter:
        return tree.Parameter(name.text, type_, default, name.span, span)

    def make_type(self, _span: Span, name: Token) -> str:
        return name.text

    def make_interval(self, span: Span, _in: Token, low: Expr, high: Expr) -> tree.Interval:
        return tree.Interval(_convert_inf(low), _convert_inf(high), span)

    # --- specifications and tests ---------------------------------------------------------------

    def make_spec_block(self, span: Span, name: Token, *clauses: tree.Clause) -> tree.SpecDecl:
        return tree.SpecDecl(name.text, clauses, True, self._doc(span), name.span, span)

    def make_spec_formula(self, span: Span, name: Token, formula: Expr) -> tree.SpecDecl:
        clause = tree.Clause("require", formula, "", name.span, formula.span)
        return tree.SpecDecl(name.text, (clause,), False, self._doc(span), name.span, span)

    def make_clause(self, span: Span, keyword: Token, value: Expr | tuple[tree.NameExpr, ...] | Token) -> tree.Clause:
        if isinstance(value, Token):
            value = tree.NameExpr(value.text, value.span)
        return tree.Clause(keyword.text, value, self._doc(span), keyword.span, span)

    def make_judge(self, span: Span, keyword: Token, _at: Token, value: Token) -> tree.Clause:
        return self.make_clause(span, keyword, value)

    def make_test(self, span: Span, title: Token, _for: Token, spec: Token, *items: tree.TestStep) -> tree.TestDecl:
        name = tree.NameExpr(spec.text, spec.span)
        return tree.TestDecl(title.text[1:-1], name, items, self._doc(span), span)

    def make_step(
        self,
        span: Span,
        _step: Token,
        times: Token | None,
        _x: Token | None,
        _for: Token | None,
        length: tree.NumberExpr | None,
        atoms: tuple[Expr, ...],
    ) -> tree.TestStep:
        count = 1
        if times is not None:
            count = int(times.text) if times.text.isdigit() and len(times.text) < 10 else 0
            if not 0 < count <= MOST_REPETITIONS:
                title = f"a step cannot be repeated {times.text} times"
                advice = f"write a whole number from 1 to {MOST_REPETITIONS}, as in `step 3x alive`"
                self._error("TLT0109", title, times.span, advice)
        return tree.TestStep(count, length, atoms, times.span if times else None, span)

    def make_expect(self, span: Span, _expect: Token, verdict: Token) -> tree.TestExpect:
        return tree.TestExpect("verdict", verdict.text, None, None, span)

    def make_expect_number(
        self, span: Span, _expect: Token, name: Token, comparator: Token, number: tree.NumberExpr
    ) -> tree.TestExpect:
        if name.text != "progress":
            self._error("TLT0108", f"a test cannot expect a number for `{name.text}`", name.span, _EXPECT_HELP)
        value = number.value / 100 if number.unit == "%" else number.value
        if number.unit not in (None, "%"):
            self._error("TLT0108", "progress has no unit", number.span, "progress runs from 0 to 1")
        return tree.TestExpect("progress", value, OPERATORS[comparator.type], number, span)

    def make_expect_state(self, span: Span, _expect: Token, name: Token, label: Token) -> tree.TestExpect:
        if name.text != "state":
            self._error("TLT0108", f"a test cannot expect a text for `{name.text}`", name.span, _EXPECT_HELP)
        return tree.TestExpect("state", label.text[1:-1], None, None, span)

    # --- expressions ----------------------------------------------------------------------------

    def make_expressions(self, _span: Span, *expressions: Expr) -> tuple[Expr, ...]:
        return expressions

    def make_names(self, _span: Span, *names: tree.NameExpr) -> tuple[tree.NameExpr, ...]:
        return names

    def make_binary(self, span: Span, left: Expr, operator: Token, right: Expr) -> tree.BinaryExpr:
        # `since` is no reserved word: its token is a name.
        return tree.BinaryExpr(OPERATORS.get(operator.type, operator.text), left, right, operator.span, span)

    def make_bounded_then(
        self, span: Span, left: Expr, operator: Token, word: Token, high: tree.NumberExpr, right: Expr
    ) -> tree.BinaryExpr:
        bound = tree.TemporalInterval(None, high, word.span.to(high.span), words=True)
        return tree.BinaryExpr("then", left, right, operator.span, span, bound)

    def make_response(
        self, span: Span, word: Token, number: Token, unit: Token, _of: Token, request: Expr, answer: Expr
    ) -> tree.BinaryExpr:
        high = self.make_number(number.span.to(unit.span), number, unit)
        bound = tree.TemporalInterval(None, high, word.span.to(high.span), words=True)
        return tree.BinaryExpr("within", request, answer, word.span, span, bound)

    def make_is_value(self, span: Span, operand: Expr, _is: Token, negation: Token | None, value: Token) -> tree.IsExpr:
        return tree.IsExpr(operand, value.text, negation is not None, _is.span, value.span, span)

    def make_unary(self, span: Span, operator: Token, operand: Expr) -> tree.Unary:
        return tree.Unary(OPERATORS[operator.type], operand, None, operator.span, span)

    def make_temporal(
        self, span: Span, operator: Token, bound: tree.TemporalInterval | None, operand: Expr
    ) -> tree.Unary:
        return tree.Unary(OPERATORS[operator.type], operand, bound, operator.span, span)

    def make_word_bound(self, span: Span, _word: Token, high: tree.NumberExpr) -> tree.TemporalInterval:
        return tree.TemporalInterval(None, high, span, words=True)

    def make_bracket_bound(self, span: Span, low: tree.NumberExpr, high: tree.NumberExpr) -> tree.TemporalInterval:
        return tree.TemporalInterval(low, high, span, words=False)

    def make_quantified(
        self, span: Span, word: Token, variable: Token, _in: Token, entities: tuple[tree.NameExpr, ...], body: Expr
    ) -> tree.Quantified:
        return tree.Quantified(word.type == "ALL", variable.text, entities, body, span)

    def make_quantified_group(
        self, span: Span, word: Token, variable: Token, _in: Token, group: tree.NameExpr, body: Expr
    ) -> tree.Quantified:
        return tree.Quantified(word.type == "ALL", variable.text, (group,), body, span, brackets=False)

    def make_when(self, span: Span, *cases_and_otherwise: tree.WhenCase | Expr) -> tree.WhenExpr:
        *cases, otherwise = cases_and_otherwise
        return tree.WhenExpr(tuple(cases), otherwise, span)  # type: ignore[arg-type]

    def make_case(self, span: Span, condition: Expr, value: Expr) -> tree.WhenCase:
        return tree.WhenCase(condition, value, span)

    def make_true(self, span: Span, _true: Token) -> tree.Constant:
        return tree.Constant(True, span)

    def make_false(self, span: Span, _false: Token) -> tree.Constant:
        return tree.Constant(False, span)

    def make_group(self, span: Span, inner: Expr) -> tree.GroupExpr:
        return tree.GroupExpr(inner, span)

    def make_call(self, span: Span, name: Token, *arguments: tree.Argument) -> tree.CallExpr:
        return tree.CallExpr(name.text, arguments, name.span, span)

    def make_argument(self, span: Span, value: Expr) -> tree.Argument:
        return tree.Argument(None, value, span)

    def make_keyword_argument(self, span: Span, name: Token, value: Expr) -> tree.Argument:
        return tree.Argument(name.text, value, span)

    def make_name(self, span: Span, name: Token) -> tree.NameExpr:
        return tree.NameExpr(name.text, span)

    def make_number(self, span: Span, number: Token, unit: Token | None) -> tree.NumberExpr:
        value = float(number.text)
        if isinf(value):
            self._error("TLT0109", "this number is too large", number.span, "write `inf` if a range has no end")
        # `step` and `steps` are the same unit.
        return tree.NumberExpr(value, unit and ("steps" if unit.text == "step" else unit.text), span)

    make_quantity = make_number

    # --- helpers --------------------------------------------------------------------------------

    def _doc(self, span: Span) -> str:
        return self._docs.get(span.start, "")

    def _error(self, code: str, title: str, span: Span, help_: str) -> None:
        self.diagnostics.append(Diagnostic(code, title, (Label(self._source, span),), help_))


def _convert_inf(limit: Expr) -> Expr:
    """Return an end of a range. If it is the name ``inf`` or ``-inf``, convert it to a number."""
    if isinstance(limit, tree.NameExpr) and limit.name == "inf":
        return tree.NumberExpr(inf, None, limit.span)
    if isinstance(limit, tree.Unary) and limit.op == "-":
        return replace(limit, operand=_convert_inf(limit.operand))
    return limit
