"""A case of the corpus: an automaton and the traces that it is run on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import EMPTY, record, replace
from tltlc.expression.tree import Expression, nodes
from tltlc.expression.tree import Param as NamedParam
from tltlc.expression.tree import Signal as NamedSignal
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import Atom, Judge, Param, Signal


@record
class Case:
    """``about`` says in a sentence what it is for; ``source`` is the text of its spec, where there is one.

    ``traces`` are whole CSV files.  The automaton's name is that of the case.
    """

    fspa: Fspa
    about: str
    traces: tuple[bytes, ...]
    source: str | None = None


Makers = Mapping[str, Callable[[], Case]]
"""Names of cases and what makes them, so that one of them costs nothing of the others."""


def automaton(
    name: str,
    formula: Formula,
    expressions: Mapping[str, Expression] = EMPTY,
    signals: Sequence[Signal] = (),
    params: Sequence[Param] = (),
    *,
    exclusive: Sequence[Sequence[str]] = (),
    limit: int | None = None,
    judge: Judge | None = None,
    infinite: bool = False,
) -> Fspa:
    """The automaton of a formula whose atoms have these expressions; without any, each is a signal in [-1, 1].

    Of ``signals`` and ``params`` those stay that the expressions use.
    """
    spec = replace(spec_from_formula(formula, name, exclusive), limit_steps=limit, judge=judge)
    if expressions:
        atoms = tuple(Atom(atom.name, expressions[atom.name]) for atom in spec.atoms)
        used = {
            node.name
            for atom in atoms
            for node in nodes(atom.expression)
            if isinstance(node, (NamedSignal, NamedParam))
        }
        kept_signals = tuple(signal for signal in signals if signal.name in used)
        kept_params = tuple(param for param in params if param.name in used)
        spec = replace(spec, atoms=atoms, signals=kept_signals, params=kept_params)
    if not infinite:
        return build(spec)
    from tltlc.automaton.infinite.build import build_infinite

    return build_infinite(replace(spec, semantics="infinite"))
