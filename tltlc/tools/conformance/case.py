"""A case of the corpus: an automaton and the traces that it runs on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from tltlc.automaton.broken_clauses import with_broken_clauses
from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET, build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import EMPTY, record, replace
from tltlc.core.source import SourceFile, Span
from tltlc.expression.tree import Expression, nodes
from tltlc.expression.tree import ParamValue as NamedParam
from tltlc.expression.tree import SignalValue as NamedSignal
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import Atom, Conjunct, JudgeMode, Param, Signal, Spec


@record
class ConformanceCase:
    """A case of the corpus: an automaton, and traces to run it on.

    The name of the automaton is the name of the case. ``about`` is a sentence that says what the case
    tests. ``source`` is the text of its spec; None if the automaton was built without a text.
    ``traces`` are the contents of CSV files.
    """

    fspa: Fspa
    about: str
    traces: tuple[bytes, ...]
    source: str | None = None


CaseBuilders = Mapping[str, Callable[[], ConformanceCase]]
"""Functions that build the cases, by the name of the case. So a caller can build only the cases it needs."""


def automaton(
    name: str,
    formula: Formula,
    expressions: Mapping[str, Expression] = EMPTY,
    signals: Sequence[Signal] = (),
    params: Sequence[Param] = (),
    *,
    exclusive: Sequence[Sequence[str]] = (),
    limit: int | None = None,
    judge: JudgeMode | None = None,
    infinite: bool = False,
) -> Fspa:
    """Return the automaton of a formula.

    ``expressions`` maps the name of each atom to its expression. Without expressions, each atom is a
    signal of the same name in [-1, 1]. Of ``signals`` and ``params``, only those that the expressions
    use are kept. ``exclusive`` has groups of names of atoms. With ``infinite``, the automaton is over
    infinite traces.
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
    spec = replace(spec, semantics="infinite" if infinite else "finite")
    fspa = _built(spec)
    return with_broken_clauses(fspa, replace(spec, parts=_clauses(formula)), DEFAULT_STATE_BUDGET)


def _built(spec: Spec) -> Fspa:
    if spec.semantics == "finite":
        return build(spec)
    from tltlc.automaton.infinite.build import build_infinite

    return build_infinite(spec)


def _clauses(formula: Formula) -> tuple[Conjunct, ...]:
    """Return the conjuncts of a formula, each as a clause."""
    conjuncts = formula.args if formula.op == "and" else (formula,)
    sources = [SourceFile("<clause>", str(conjunct), "text") for conjunct in conjuncts]
    return tuple(
        Conjunct(conjunct, source, Span(0, len(source.text)))
        for conjunct, source in zip(conjuncts, sources, strict=True)
    )
