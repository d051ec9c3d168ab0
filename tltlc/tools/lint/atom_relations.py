"""Find atoms over the same signals that exclude each other, such as ``x > 5`` and ``x < 3``."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from functools import lru_cache
from itertools import combinations, product
from typing import Final

from tltlc.core.record import record
from tltlc.expression.tree import Condition, Const, Op, When, nodes
from tltlc.expression.tree import ParamValue as ParamNode
from tltlc.expression.tree import SignalValue as SignalNode
from tltlc.logic.formula import Formula, always, and_, atom, not_
from tltlc.resolve.spec import Atom, Conjunct, Param, Register, Signal
from tltlc.tools.lint.atom_signs import can_be, is_always
from tltlc.tools.lint.file_view import SpecView

_MOST_NODES: Final = 40
_MOST_PAIRS: Final = 24
_TRIES: Final = 40
"""Limits that keep lint rules fast.

They are, in this order: the most nodes of an atom's expression, the most pairs of atoms, and the
most samples to try for a pair of atoms before a proof is tried.
"""


@record
class _DeclaredSignals:
    signals: tuple[Signal, ...]
    params: tuple[Param, ...]
    registers: tuple[Register, ...]


def relations(spec: SpecView, names: Collection[str]) -> tuple[Conjunct, ...]:
    """Return what can be proved about pairs of the atoms ``names``, as clauses to add to the spec.

    Each clause has the form ``G !(p & q)``: p and q never hold together. Each of p and q is an atom
    or a negated atom, and both atoms read a common signal. For example, ``x > 5`` and ``x < 3`` give
    ``G !(x > 5 & x < 3)``.
    """
    formulas = (always(not_(pair)) for pair in _impossible_pairs(spec, names))
    return tuple(Conjunct(formula, spec.spec.source, spec.spec.name_span) for formula in formulas)


def is_impossible(spec: SpecView) -> bool:
    """Whether no trace satisfies a spec, given what :func:`relations` proves about its atoms."""
    if spec.fspa.states[0].verdict == "violated":
        return True
    proved = relations(spec, [candidate.name for candidate in spec.fspa.atoms])
    return bool(proved) and spec.decision((*spec.spec.parts, *proved), spec.spec)


def _impossible_pairs(spec: SpecView, names: Collection[str]) -> Iterator[Formula]:
    """Yield conjunctions such as ``x > 5 & x < 3``, of two atoms or negated atoms, that provably never hold."""
    declared = _DeclaredSignals(spec.fspa.signals, spec.fspa.params, spec.fspa.registers)
    simple = [candidate for candidate in spec.fspa.atoms if candidate.name in names and _is_simple(candidate)]
    pairs = [pair for pair in combinations(simple, 2) if _signals(pair[0]) & _signals(pair[1])]
    for pair in pairs[:_MOST_PAIRS]:
        for signs in product((True, False), repeat=2):
            if _never_hold_together(pair, signs, declared):
                both = (atom(member.name) for member in pair)
                yield and_(*(formula if holds else not_(formula) for formula, holds in zip(both, signs, strict=True)))


@lru_cache(maxsize=1024)
def _never_hold_together(pair: tuple[Atom, Atom], signs: tuple[bool, ...], declared: _DeclaredSignals) -> bool:
    """Whether two atoms provably never have the truth values ``signs`` at the same step."""
    conditions = tuple(
        Condition(">" if holds else "<=", (member.expression, Const(0.0)))
        for member, holds in zip(pair, signs, strict=True)
    )
    both = Atom("", When(((Condition("and", conditions), Const(1.0)),), Const(-1.0)))
    return not can_be("positive", both, declared, _TRIES) and is_always("not positive", both, declared)


def _is_simple(candidate: Atom) -> bool:
    """Whether the expression of an atom is small and piecewise linear in signals and params."""
    count = 0
    for count, node in enumerate(nodes(candidate.expression), start=1):
        if count > _MOST_NODES or isinstance(node, When) or (isinstance(node, Op) and not _is_linear(node)):
            return False
    return count > 0


def _is_linear(node: Op) -> bool:
    if node.op in ("*", "/"):
        first, second = (any(isinstance(child, (SignalNode, ParamNode)) for child in nodes(arg)) for arg in node.args)
        return not second or (node.op == "*" and not first)
    return node.op in ("+", "-", "neg", "min", "max", "clamp", "abs")


def _signals(candidate: Atom) -> set[str]:
    return {node.name for node in nodes(candidate.expression) if isinstance(node, SignalNode)}
