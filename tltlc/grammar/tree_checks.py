"""Check the syntax tree for what the grammar accepts but the language forbids.

A clause gets at most one error.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, replacement_fix
from tltlc.grammar import tree
from tltlc.grammar.keywords import JUDGE, SEMANTICS, VERDICTS, closest_word
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.then_rule import check_then
from tltlc.grammar.tree import Declaration, Expr
from tltlc.grammar.walk import expressions, parts

_FORMULA_CLAUSES: Final = {"reach", "keep", "avoid", "require"}
_BOUND_OPERATORS: Final = {"within": ("F", "once"), "for": ("G", "historically"), "after": ("X", "N"), "[": ("F", "G")}
_BOUND_HELP: Final = {
    "F": "`eventually within 20 steps p` or `F[0,20] p`",
    "G": "`always for 20 steps p` or `G[0,19] p`",
    "X": "`next after 3 steps p`",
    "N": "`weak_next after 3 steps p`",
    "once": "`once within 20 steps p`",
    "historically": "`historically for 20 steps p`",
    "previously": "`once within 20 steps p`, or `previously p` without a bound",
    "begins": "`once within 20 steps begins p`, or `begins p` without a bound",
    "ends": "`once within 20 steps ends p`, or `ends p` without a bound",
}
_AFTER: Final = {
    "F": "`next after {time} eventually p`, or `eventually within {time} p` for the time until then",
    "G": "`weak_next after {time} always p`, or `always for {time} p` for the time until then",
}
_VARYING_AFTER: Final = {
    "F": "`eventually (p and time_holding(true) >= {time})`, which counts from the first step",
    "G": "`always (time_holding(true) >= {time} implies p)`, which counts from the first step",
}
"""How to write operators that begin later."""

_VARYING_BOUND_HELP: Final = {
    "F": "`eventually within 2 s p`",
    "G": "`always for 2 s p`",
    "X": "`next p` without a bound",
    "N": "`weak_next p` without a bound",
    "once": "`once within 2 s p`",
    "historically": "`historically for 2 s p`",
    "previously": "`once within 2 s p`, or `previously p` without a bound",
    "begins": "`once within 2 s begins p`, or `begins p` without a bound",
    "ends": "`once within 2 s ends p`, or `ends p` without a bound",
}
"""How to write bounds where the clock varies."""
_EACH_OR_SOME: Final = "write `{each}` if it must hold at each step of that time, `{some}` if at some step of it"
_FUTURE: Final = _EACH_OR_SOME.format(each="always for {t} {p}", some="eventually within {t} {p}")
_PAST: Final = _EACH_OR_SOME.format(each="historically for {t} {p}", some="once within {t} {p}")
_FROM_NEXT: Final = "write `weak_next always for {t} {p}` if it must hold for that time from the next step on"
_OTHER_WORD: Final = {
    ("G", "within"): _FUTURE,
    ("F", "for"): _FUTURE,
    ("historically", "within"): _PAST,
    ("once", "for"): _PAST,
    ("X", "for"): _FROM_NEXT,
    ("N", "for"): _FROM_NEXT,
    ("X", "within"): "write `next eventually within {t} {p}`",
}
"""Helps for the bound of another operator, by the operator and the word of the bound.

``{t}`` is the time, and ``{p}`` the formula.
"""
_LONGEST: Final = 60
"""The most characters of a formula that a help repeats."""


def check(source: SourceFile, declarations: Iterable[Declaration]) -> Iterator[Diagnostic]:
    """Yield the errors in declarations that the parser accepted: in whole specs, clauses and expressions."""
    for declaration in declarations:
        if isinstance(declaration, tree.SpecDecl):
            yield from _check_spec(source, declaration)
        yield from check_clauses(source, (declaration,))


def check_clauses(source: SourceFile, declarations: Iterable[Declaration]) -> Iterator[Diagnostic]:
    """Yield the errors inside clauses and expressions, without errors about a spec as a whole."""
    for declaration in declarations:
        match declaration:
            case tree.SpecDecl():
                for clause in declaration.clauses:
                    yield from check_clause(source, clause)
            case tree.TestDecl():
                yield from _check_test(source, declaration)
            case _:
                yield from _only_first(
                    error for part in expressions(declaration) for error in check_formula(source, part)
                )


def check_formula(source: SourceFile, formula: Expr, *, in_reach: bool = False) -> Iterator[Diagnostic]:
    """Yield the first error in an expression, if there is one.

    ``in_reach`` is True in a ``reach`` clause, where ``then`` needs fewer brackets.
    """
    yield from _only_first(_expression_errors(source, formula, in_reach))


def _expression_errors(source: SourceFile, formula: Expr, in_reach: bool) -> Iterator[Diagnostic]:
    yield from check_then(source, formula, in_reach=in_reach)
    for part in parts(formula):
        if isinstance(part, tree.Unary) and part.bound:
            yield from _check_bound(source, part, part.bound)


def _check_bound(source: SourceFile, formula: tree.Unary, bound: tree.TemporalInterval) -> Iterator[Diagnostic]:
    # Compare only the beginning, because the span may contain a comment after the word.
    word = next(word for word in _BOUND_OPERATORS if source.slice(bound.span).startswith(word))
    if formula.op in _BOUND_OPERATORS[word]:
        return
    operator = source.slice(formula.op_span)
    form = f"with `{word}`" if bound.words else "in brackets"
    title = f"`{operator}` takes no bound {form}"
    varies = declared_names(source).clock_varies
    template, is_timed = _OTHER_WORD.get((formula.op, word)), bound.high.unit not in (None, "step", "steps")
    help_ = f"write {(_VARYING_BOUND_HELP if varies else _BOUND_HELP)[formula.op]}"
    if template is not None and bound.words and (is_timed or not varies):
        operand = _on_one_line(source, formula.operand.span)
        time, operand = _on_one_line(source, bound.high.span), operand if len(operand) <= _LONGEST else "p"
        help_ = template.format(t=time, p=operand)
        if word == "for" and formula.op in ("X", "N") and not varies:
            help_ += (
                f", `{'next' if formula.op == 'X' else 'weak_next'} after {time} {operand}` if at the step after it"
            )
    if word == "after" and formula.op in _AFTER:
        later = (_VARYING_AFTER if varies else _AFTER)[formula.op]
        help_ = f"write {later.format(time=_on_one_line(source, bound.high.span))}"
    yield _error(source, "TLT0111", title, bound.span, help_)


def _on_one_line(source: SourceFile, span: Span) -> str:
    return " ".join(source.slice(span).split())


def _check_spec(source: SourceFile, spec: tree.SpecDecl) -> Iterator[Diagnostic]:
    if "." in spec.name:
        plain = spec.name.replace(".", "_")
        title = "the name of a spec cannot contain dots"
        yield _error(source, "TLT0113", title, spec.name_span, f"write `{plain}`", write=plain)
    if not any(clause.kind in _FORMULA_CLAUSES for clause in spec.clauses):
        title = f"`{spec.name}` does not ask for anything"
        help_ = "add a clause: `reach`, `keep`, `avoid` or `require`"
        yield _error(source, "TLT0112", title, spec.name_span, help_)


def check_clause(source: SourceFile, clause: tree.Clause) -> Iterator[Diagnostic]:
    """Yield the errors in a clause of a spec."""
    if isinstance(clause.value, tuple):
        return
    if clause.kind in _FORMULA_CLAUSES:
        yield from check_formula(source, clause.value, in_reach=clause.kind == "reach")
    elif clause.kind in ("judge", "semantics") and isinstance(clause.value, tree.NameExpr):
        words, form = (JUDGE, "judge at") if clause.kind == "judge" else (SEMANTICS, "semantics")
        yield from _check_word(source, clause.value.name, clause.value.span, words, form)


def _check_test(source: SourceFile, test: tree.TestDecl) -> Iterator[Diagnostic]:
    for item in test.items:
        if isinstance(item, tree.TestStep):
            yield from _only_first(error for atom in item.atoms for error in check_formula(source, atom))
        elif item.kind == "verdict":
            word = str(item.value)
            span = Span(item.span.end - len(word), item.span.end)
            yield from _check_word(source, word, span, VERDICTS, "expect")


_COMPARED: Final = {
    "progress": "compare it with a number: `expect progress >= 0.5`",
    "state": 'write the label of the state: `expect state "F a"`',
}


def _check_word(source: SourceFile, word: str, span: Span, words: tuple[str, ...], form: str) -> Iterator[Diagnostic]:
    if word not in words:
        suggestion = closest_word(word, words)
        listed = ", ".join(f"`{form} {allowed}`" for allowed in words[:-1]) + f" or `{form} {words[-1]}`"
        help_ = _COMPARED.get(word) or (f"did you mean `{suggestion}`?" if suggestion else f"write {listed}")
        replacement = None if word in _COMPARED else suggestion
        yield _error(source, "TLT0108", f"`{word}` is not known here", span, help_, write=replacement)


def _only_first(errors: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    for error in errors:
        yield error
        return


def _error(
    source: SourceFile, code: str, title: str, span: Span, help_: str, *, write: str | None = None
) -> Diagnostic:
    fixes = (replacement_fix(source, span, write),) if write is not None else ()
    return Diagnostic(code, title, (Label(source, span),), help_, fixes=fixes)
