"""What atoms that read the same signals have to do with each other, such as ``x > 5`` and ``x < 3``."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from functools import lru_cache
from itertools import combinations, product
from typing import Final

from tltlc.core.record import record
from tltlc.expression.tree import Condition, Const, Op, When, nodes
from tltlc.expression.tree import Param as ParamNode
from tltlc.expression.tree import Signal as SignalNode
from tltlc.logic.formula import Formula, always, and_, atom, not_
from tltlc.resolve.spec import Atom, Param, Part, Signal
from tltlc.tools.lint.atom_signs import can_be, is_always
from tltlc.tools.lint.file_view import SpecView

_MOST_NODES: Final = 40
_MOST_PAIRS: Final = 24
_TRIES: Final = 40
"""Larger expressions, and more pairs, take too long for a remark; after as many points the proof is tried."""


@record
class _Declared:
    signals: tuple[Signal, ...]
    params: tuple[Param, ...]


def relations(spec: SpecView, names: Collection[str]) -> tuple[Part, ...]:
    """What the ranges of signals say of these atoms at every step: which two, or their negations, never meet.

    Only what is proved is among it.
    """
    found = (always(not_(pair)) for pair in _pairs(spec, names))
    return tuple(Part(each, spec.spec.source, spec.spec.name_span) for each in found)


def is_impossible(spec: SpecView) -> bool:
    """Whether no trace satisfies a spec, by its formula or by what is known of its atoms."""
    if spec.fspa.states[0].verdict == "violated":
        return True
    known = relations(spec, [each.name for each in spec.fspa.atoms])
    return bool(known) and spec.decision((*spec.spec.parts, *known), spec.spec)


def _pairs(spec: SpecView, names: Collection[str]) -> Iterator[Formula]:
    declared = _Declared(spec.fspa.signals, spec.fspa.params)
    simple = [each for each in spec.fspa.atoms if each.name in names and _is_simple(each)]
    pairs = [pair for pair in combinations(simple, 2) if _reads(pair[0]) & _reads(pair[1])]
    for pair in pairs[:_MOST_PAIRS]:
        for signs in product((True, False), repeat=2):
            if _never_meet(pair, signs, declared):
                both = (atom(each.name) for each in pair)
                yield and_(*(each if holds else not_(each) for each, holds in zip(both, signs, strict=True)))


@lru_cache(maxsize=1024)
def _never_meet(pair: tuple[Atom, Atom], signs: tuple[bool, ...], declared: _Declared) -> bool:
    """Whether it is proved that atoms never have these truths at one step."""
    conditions = tuple(
        Condition(">" if holds else "<=", (each.expression, Const(0.0)))
        for each, holds in zip(pair, signs, strict=True)
    )
    both = Atom("", When(((Condition("and", conditions), Const(1.0)),), Const(-1.0)))
    return not can_be("positive", both, declared, _TRIES) and is_always("not positive", both, declared)


def _is_simple(of: Atom) -> bool:
    """Whether an expression is made of few sums and multiples of what is read, as that of a comparison mostly is."""
    count = 0
    for count, node in enumerate(nodes(of.expression), start=1):
        if count > _MOST_NODES or isinstance(node, When) or (isinstance(node, Op) and not _is_linear(node)):
            return False
    return count > 0


def _is_linear(node: Op) -> bool:
    if node.op in ("*", "/"):
        first, second = (any(isinstance(each, (SignalNode, ParamNode)) for each in nodes(arg)) for arg in node.args)
        return not second or (node.op == "*" and not first)
    return node.op in ("+", "-", "neg", "min", "max", "clamp", "abs")


def _reads(of: Atom) -> set[str]:
    return {node.name for node in nodes(of.expression) if isinstance(node, SignalNode)}
