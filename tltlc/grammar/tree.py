"""The nodes of the syntax tree: frozen records, each with its span in the source text.

Formulas and arithmetic are both expressions, since an LALR(1) parser that reads an opening bracket
cannot know whether a formula or arithmetic follows; :mod:`tltlc.resolve` finds the types. Each
operator is stored under one canonical spelling: ``not and or implies iff F G X N U W R M then`` and
``+ - * / ^ < <= > >= == !=``.

The field ``doc`` has the text of the ``///`` comment before a declaration or clause; it is empty
without one. The fields whose names end in ``_span`` are the spans of a part, such as the name.
"""

from __future__ import annotations

from typing import Union

from tltlc.core.record import record
from tltlc.core.source import Span

# --- expressions ------------------------------------------------------------------------------


@record
class NumberExpr:
    """A number; ``unit`` is ``m``, ``%``, ``steps``, …, or None. ``inf`` is a number, too."""

    value: float
    unit: str | None
    span: Span


@record
class Constant:
    """The constant ``true`` or ``false``."""

    value: bool
    span: Span


@record
class NameExpr:
    """A name without arguments, such as ``alive``; it may contain dots: ``st.near``."""

    name: str
    span: Span


@record
class Argument:
    """An argument of a call; ``name`` is None unless it is a keyword argument."""

    name: str | None
    value: Expr
    span: Span


@record
class CallExpr:
    """A call ``name(arguments)`` of a predicate, a signal with parameters, a ``let`` or a function."""

    name: str
    arguments: tuple[Argument, ...]
    name_span: Span
    span: Span


@record
class TemporalInterval:
    """The bound of a temporal operator, in steps or as a time: ``[0, 20]`` or ``within 20 steps``.

    ``low`` is None for the words ``within``, ``for`` and ``after``.
    """

    low: NumberExpr | None
    high: NumberExpr
    span: Span
    words: bool
    """True for a bound in words, ``within 20 steps``, False for one in brackets, ``F[0,20]``."""


@record
class Unary:
    """``-``, ``not`` or a temporal operator ``F G X N`` before an operand, perhaps with a bound."""

    op: str
    operand: Expr
    bound: TemporalInterval | None
    op_span: Span
    span: Span


@record
class BinaryExpr:
    """An infix operator between two operands.

    ``bound`` is the bound of ``a then within 5 s b``. The form ``within 5 s of a, b`` is the operator
    ``within``, with a bound, too. Other operators have no bound.
    """

    op: str
    left: Expr
    right: Expr
    op_span: Span
    span: Span
    bound: TemporalInterval | None = None


@record
class IsExpr:
    """A test for a value of an enum: ``mode(g1) is alert``, or ``mode(g1) is not alert`` if ``negated``.

    ``value`` is the name of the value. It is no reference to a declaration.
    """

    operand: Expr
    value: str
    negated: bool
    is_span: Span
    value_span: Span
    span: Span


@record
class GroupExpr:
    """An expression in round brackets. The brackets are kept because ``then`` requires them."""

    inner: Expr
    span: Span


@record
class Quantified:
    """A quantifier: ``all x in (s1, s2): body`` (``all`` is True) or ``any x in (…): body``.

    ``entities`` may also name groups. Without ``brackets``, as in ``all x in guards: body``, there is
    one name.
    """

    all: bool
    variable: str
    entities: tuple[NameExpr, ...]
    body: Expr
    span: Span
    brackets: bool = True


@record
class WhenCase:
    """A case of a :class:`WhenExpr`: ``when condition: value``."""

    condition: Expr
    value: Expr
    span: Span


@record
class WhenExpr:
    """A case distinction, ``when condition: value … otherwise: value``; only in predicates."""

    cases: tuple[WhenCase, ...]
    otherwise: Expr
    span: Span


Expr = Union[NumberExpr, Constant, NameExpr, CallExpr, Unary, BinaryExpr, IsExpr, GroupExpr, Quantified, WhenExpr]

# --- declarations -----------------------------------------------------------------------------


@record
class Import:
    """An import: ``import stealth (near)``, ``import stealth as st`` or ``import "file.tltl"``.

    ``target`` is the name of a library, or a path if ``is_path``. ``names`` are the names in brackets;
    None if there are no brackets. ``alias`` is the name after ``as``, or None.
    """

    target: str
    is_path: bool
    names: tuple[NameExpr, ...] | None
    alias: str | None
    target_span: Span
    span: Span


@record
class Interval:
    """A range, ``in [low, high]``.

    Both ends are constant expressions, such as ``-1``, ``2 m``, ``inf``.
    """

    low: Expr
    high: Expr
    span: Span


@record
class Parameter:
    """A parameter of a signal, predicate or ``let``: ``name: type = default``."""

    name: str
    type: str | None
    default: Expr | None
    name_span: Span
    span: Span


@record
class SignalDecl:
    """A declaration of a signal: ``signal distance(target: entity): length in [0 m, inf]``.

    ``type`` is None if only a range is given, as in ``signal coins in [0, 50]``. ``values`` are the
    names of the values of an enum, ``signal mode: (idle, alert)``, whose ``type`` is ``int``.
    """

    name: str
    parameters: tuple[Parameter, ...]
    type: str | None
    interval: Interval | None
    doc: str
    name_span: Span
    span: Span
    values: tuple[NameExpr, ...] = ()


@record
class EntityDecl:
    """A declaration of entities: ``entity a, b``."""

    names: tuple[NameExpr, ...]
    doc: str
    span: Span


@record
class GroupDecl:
    """A declaration of a group of entities: ``entity guards = g1, g2``. A member may be a group, too."""

    name: str
    members: tuple[NameExpr, ...]
    doc: str
    name_span: Span
    span: Span


@record
class ParamDecl:
    """A declaration of a param: ``param level_size: length in [2 m, 10 km] = 20 m``."""

    name: str
    type: str | None
    interval: Interval | None
    value: Expr
    doc: str
    name_span: Span
    span: Span


@record
class ClockDecl:
    """A declaration of the clock: ``clock 20 Hz`` or ``clock 0.05 s``; for ``clock varies``, ``value`` is None."""

    value: NumberExpr | None
    span: Span


@record
class PredicateDecl:
    """A predicate: ``predicate near(target: entity) in [-1, 1] = expression``."""

    name: str
    parameters: tuple[Parameter, ...]
    interval: Interval | None
    body: Expr
    doc: str
    name_span: Span
    span: Span


@record
class LetDecl:
    """A named formula: ``let name(parameters) = formula``, or ``let name = formula``."""

    name: str
    parameters: tuple[Parameter, ...]
    body: Expr
    doc: str
    name_span: Span
    span: Span


@record
class ExclusiveDecl:
    """A declaration of atoms that never hold together: ``exclusive A, B, …``."""

    atoms: tuple[Expr, ...]
    span: Span


@record
class Clause:
    """A clause of a spec.

    ``kind`` is its keyword, which decides what ``value`` is:

    - ``reach``, ``keep``, ``avoid``, ``require``: an expression;
    - ``level``, ``judge``, ``semantics``: a NameExpr;
    - ``limit``: a NumberExpr;
    - ``tag``: a tuple of NameExpr.
    """

    kind: str
    value: Expr | tuple[NameExpr, ...]
    doc: str
    keyword_span: Span
    span: Span


@record
class SpecDecl:
    """A spec: ``spec NAME { clauses }``, or ``spec NAME = FORMULA``.

    ``block`` is True for the first form. The second has one clause, a ``require`` with the formula.
    """

    name: str
    clauses: tuple[Clause, ...]
    block: bool
    doc: str
    name_span: Span
    span: Span


@record
class TestStep:
    """A line of a test that gives a sample: ``step 3x alive, not near(s1)``, or ``step for 2 s alive``.

    The sample is repeated ``times`` times. ``times_span`` is the place of the number ``3``; None if the
    line has no number, and ``times`` is 1. ``length`` is the time that each takes, None without one.
    ``atoms`` are the expressions after it, with ``=`` to set a number.
    """

    times: int
    length: NumberExpr | None
    atoms: tuple[Expr, ...]
    times_span: Span | None
    span: Span


@record
class TestExpect:
    """A line of a test: ``expect pending``, ``expect progress >= 0.5``, ``expect state "G p"``.

    ``kind`` is ``verdict``, ``progress`` or ``state``. ``value`` is the verdict, the progress as a
    share of 1, or the label. For progress, ``comparison`` is one of ``< <= > >=``, and ``number`` is
    the number as it is written, perhaps in percent; both are None for other kinds.
    """

    kind: str
    value: str | float
    comparison: str | None
    number: NumberExpr | None
    span: Span


@record
class TestDecl:
    """A test: ``test "title" for SPEC { step … expect … }``."""

    title: str
    spec: NameExpr
    items: tuple[Union[TestStep, TestExpect], ...]
    doc: str
    span: Span


Declaration = Union[
    Import,
    SignalDecl,
    EntityDecl,
    GroupDecl,
    ParamDecl,
    ClockDecl,
    PredicateDecl,
    LetDecl,
    ExclusiveDecl,
    SpecDecl,
    TestDecl,
]
