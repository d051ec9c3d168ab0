"""Split a spec into its clauses and build an automaton for each.

These automata show which clauses are to blame if a trace is not accepted.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Final

from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile, Span
from tltlc.expression.tree import SignalValue, nodes
from tltlc.logic.formula import TRUE, Formula, and_
from tltlc.logic.text.printer import ascii_text
from tltlc.pipeline import CompileOptions, build_spec
from tltlc.resolve.spec import Spec

_COMMENT: Final = re.compile(r"//[^\n]*")


@record
class ClauseAutomaton:
    """A clause of a spec, or a conjunct of its formula, with an automaton for this part alone.

    ``text`` is the clause as it is written, on one line with single blanks: ``avoid on_lava``. For
    an artefact, which has no source text, it is the conjunct in the ASCII notation: ``G !on_lava``.
    """

    text: str
    fspa: Fspa


@record
class Clauses:
    """The clauses of a spec.

    ``parts`` has the clauses in order, without those whose automaton would be too large. ``are_all``
    is true if no clause is missing and there is at least one. ``whole`` is the spec. An automaton
    may have at most ``state_budget`` states.
    """

    parts: tuple[ClauseAutomaton, ...]
    are_all: bool
    whole: Spec
    state_budget: int

    def together(self, chosen: Sequence[int]) -> Fspa | None:
        """Return the automaton of the conjunction of some parts; None if it would be too large.

        ``chosen`` has their indices in ``parts``.
        """
        formulas = [part.fspa.formula for part in (self.parts[index] for index in chosen)]
        conjunction = and_(*(formula for formula in formulas if isinstance(formula, Formula)))
        return _automaton(self.whole, conjunction, self.state_budget)


def clauses_of(fspa: Fspa, spec: Spec | None, state_budget: int = DEFAULT_STATE_BUDGET) -> Clauses:
    """Return the clauses of a spec.

    ``spec`` is what ``fspa`` was built from; None for an artefact. The automaton of a clause may have
    at most ``state_budget`` states. An automaton of another tool, whose formula is only a text, has
    no clauses.
    """
    conjuncts = list(_conjuncts_of_artefact(fspa) if spec is None else _conjuncts_of_source(spec))
    whole = replace(_as_spec(fspa) if spec is None else spec, parts=())
    built = [(text, _automaton(whole, formula, state_budget)) for text, formula in conjuncts]
    parts = tuple(ClauseAutomaton(text, automaton) for text, automaton in built if automaton is not None)
    return Clauses(parts, len(parts) == len(conjuncts) > 0, whole, state_budget)


def _automaton(whole: Spec, formula: Formula, state_budget: int) -> Fspa | None:
    """Return the automaton of the spec ``whole`` with ``formula`` in place of its own formula.

    Returns None if the automaton would be too large.
    """
    return build_spec(_with_formula(whole, formula), CompileOptions(state_budget=state_budget))[0]


def _with_formula(whole: Spec, formula: Formula) -> Spec:
    """Return the spec ``whole`` with another formula, and only the atoms and signals it needs.

    A formula needs the atoms that occur in it, and all atoms of each ``exclusive`` group of which
    at least two occur in it.
    """
    used = set(formula.atoms())
    groups = [{whole.atoms[index].name for index in group} for group in whole.exclusive]
    groups = [group for group in groups if len(group & used) > 1]
    atoms = tuple(atom for atom in whole.atoms if atom.name in used.union(*groups))
    index_of = {atom.name: index for index, atom in enumerate(atoms)}
    read = {node.name for atom in atoms for node in nodes(atom.expression) if isinstance(node, SignalValue)}
    return replace(
        whole,
        formula=formula,
        atoms=atoms,
        signals=tuple(signal for signal in whole.signals if signal.name in read),
        exclusive=tuple(tuple(sorted(index_of[name] for name in group)) for group in groups),
    )


def _conjuncts_of_source(spec: Spec) -> Iterator[tuple[str, Formula]]:
    for part in spec.parts:
        text = _COMMENT.sub(" ", part.source.text[part.span.start : part.span.end])
        yield " ".join(text.split()), part.formula


def _conjuncts_of_artefact(fspa: Fspa) -> Iterator[tuple[str, Formula]]:
    # In an automaton of another tool, the formula may be only a name that reads like a formula.
    if isinstance(fspa.formula, Formula) and all(isinstance(state.label, Formula) for state in fspa.states):
        for conjunct in fspa.formula.args if fspa.formula.op == "and" else (fspa.formula,):
            yield ascii_text(conjunct), conjunct


def _as_spec(fspa: Fspa) -> Spec:
    """Return a spec with the fields of an automaton. Its formula is ``true``; the caller replaces it."""
    return Spec(
        name=fspa.name,
        doc=fspa.doc,
        formula=TRUE,
        parts=(),
        atoms=fspa.atoms,
        signals=fspa.signals,
        params=fspa.params,
        exclusive=fspa.exclusive,
        level=fspa.level,
        limit_steps=fspa.limit_steps,
        judge=fspa.judge,
        semantics=fspa.semantics,
        tags=fspa.tags,
        clock_s=fspa.clock_s,
        source=SourceFile(f"<{fspa.name}>", "", "text"),
        name_span=Span(0, 0),
    )
