"""Split a spec into its clauses and build an automaton for each.

These automata show which clauses are to blame if a trace is not accepted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory_phrases import spoken
from tltlc.automaton.text import times_of
from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile, Span
from tltlc.expression.tree import AtomValue, Before, SignalValue, nodes
from tltlc.logic.formula import FALSE, TRUE, Formula, and_
from tltlc.logic.text.english import clause_text, invariant_text, without_constants
from tltlc.logic.text.printer import ascii_text
from tltlc.pipeline import CompileOptions, build_spec
from tltlc.resolve.spec import Spec

_MOST_NODES: Final = 100
"""A conjunct with more different parts is named by its formula, because its words would be too many."""


@record
class ClauseAutomaton:
    """A clause of a spec, with an automaton for this clause alone.

    ``text`` is the clause as the source has it, on one line with single blanks: ``avoid on_lava``.
    An artefact (a compiled spec) has no source text. Its clauses are the conjuncts of its formula,
    and ``text`` says in words what a conjunct asks for, such as ``avoid on_lava`` for ``G !on_lava``.
    """

    text: str
    fspa: Fspa


@record
class Clauses:
    """The clauses of a spec.

    ``parts`` has the clauses in order, without those whose automaton would need more than
    ``state_budget`` states. ``are_all`` is true if ``parts`` has every clause, and at least one.
    ``whole`` has the atoms, signals and settings that all clauses share; its own formula is not used.
    """

    parts: tuple[ClauseAutomaton, ...]
    are_all: bool
    whole: Spec
    state_budget: int

    def together(self, chosen: Sequence[int]) -> Fspa | None:
        """Return one automaton for several clauses: it accepts the traces that satisfy all of them.

        ``chosen`` has the indices of the clauses in ``parts``. Return None if the automaton would
        need more than ``state_budget`` states.
        """
        formulas = [part.fspa.formula for part in (self.parts[index] for index in chosen)]
        conjunction = and_(*(formula for formula in formulas if isinstance(formula, Formula)))
        return _automaton(self.whole, conjunction, self.state_budget)


def clauses_of(fspa: Fspa, spec: Spec | None, state_budget: int = DEFAULT_STATE_BUDGET) -> Clauses:
    """Return the clauses of the spec that ``fspa`` was built from.

    ``spec`` is this spec. It is None if ``fspa`` was read from an artefact (a compiled spec); then
    the clauses are the conjuncts of the formula of ``fspa``. The result has no clauses if another
    tool made the automaton and its formula is only a text. The automaton of a clause may have at
    most ``state_budget`` states.
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
    """Return the spec ``whole`` with another formula, and only the atoms, signals and registers it needs.

    A formula needs the atoms that occur in it, the atoms and registers that these read, and all atoms
    of each ``exclusive`` group of which at least two are among these.
    """
    used, _ = _read(whole, set(formula.atoms()))
    groups = [{whole.atoms[index].name for index in group} for group in whole.exclusive]
    groups = [group for group in groups if len(group & used) > 1]
    used, read = _read(whole, used.union(*groups))
    atoms = tuple(atom for atom in whole.atoms if atom.name in used)
    index_of = {atom.name: index for index, atom in enumerate(atoms)}
    return replace(
        whole,
        formula=formula,
        atoms=atoms,
        signals=tuple(signal for signal in whole.signals if signal.name in read),
        exclusive=tuple(tuple(sorted(index_of[name] for name in group)) for group in groups),
        registers=tuple(register for register in whole.registers if register.name in read),
    )


def _read(whole: Spec, names: set[str]) -> tuple[set[str], set[str]]:
    """Return the atoms ``names`` with those that their registers read, and all signals and registers that these read.

    All are names.
    """
    expressions = {atom.name: atom.expression for atom in whole.atoms}
    updates = {register.name: register.update for register in whole.registers}
    atoms, read = set(names), set[str]()
    pending = [expressions[name] for name in sorted(names)]
    while pending:
        for node in nodes(pending.pop()):
            if isinstance(node, AtomValue) and node.name not in atoms:
                atoms.add(node.name)
                pending.append(expressions[node.name])
            elif isinstance(node, (SignalValue, Before)) and node.name not in read:
                read.add(node.name)
                if node.name in updates:
                    pending.append(updates[node.name])
    return atoms, read


def _conjuncts_of_source(spec: Spec) -> Iterator[tuple[str, Formula]]:
    for part in spec.parts:
        yield part.text, part.formula


def _conjuncts_of_artefact(fspa: Fspa) -> Iterator[tuple[str, Formula]]:
    # In an automaton of another tool, the formula may be only a name that reads like a formula.
    if isinstance(fspa.formula, Formula) and all(isinstance(state.label, Formula) for state in fspa.states):
        for conjunct in _whole_rules(fspa, fspa.formula.args if fspa.formula.op == "and" else (fspa.formula,)):
            yield _conjunct_text(conjunct, fspa), conjunct


def _whole_rules(fspa: Fspa, conjuncts: Sequence[Formula]) -> list[Formula]:
    """Join the conjuncts that say one thing together: that no answer is late, and that none is due at the end."""
    rules: list[Formula] = []
    for conjunct in conjuncts:
        joined = (
            (index, and_(rule, conjunct)) for index, rule in enumerate(rules) if fspa.registers and rule.op == "G"
        )
        place = next(((index, both) for index, both in joined if spoken(both, fspa).op == "G"), None)
        if place is None:
            rules.append(conjunct)
        else:
            rules[place[0]] = place[1]
    return rules


def _conjunct_text(conjunct: Formula, fspa: Fspa) -> str:
    """Return the text of a conjunct in words; as a formula if constants or its size make it hard to say."""
    endless = fspa.semantics == "infinite"
    in_words = spoken(conjunct, fspa)
    in_words = in_words if endless else without_constants(in_words)
    nodes_of_conjunct = {*in_words.walk()}
    is_hard = endless and not nodes_of_conjunct.isdisjoint((TRUE, FALSE))
    if len(nodes_of_conjunct) > _MOST_NODES or is_hard or in_words in (TRUE, FALSE):
        return ascii_text(conjunct)
    text = invariant_text if in_words.op == "G" else clause_text
    return text(in_words, endless=endless, counts=times_of(fspa))


def _as_spec(fspa: Fspa) -> Spec:
    """Return a spec with the atoms, signals and settings of an automaton.

    Its formula is ``true``; the caller replaces it.
    """
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
        clock_varies=fspa.clock_varies,
        registers=fspa.registers,
        source=SourceFile(f"<{fspa.name}>", "", "text"),
        name_span=Span(0, 0),
    )
