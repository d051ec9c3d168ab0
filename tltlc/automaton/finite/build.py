"""Build the automaton of a resolved spec over finite traces.

The stages are: formula -> negation normal form -> minimal machine (accepting transitions) -> states
with acceptance -> distances, verdicts, guards, labels -> :class:`~tltlc.automaton.fspa.Fspa`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext

from tltlc.automaton.default_judge import default_judge, judge_of
from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.finite.blowup import budget_error, recursion_room
from tltlc.automaton.finite.composition import minimal_machine as compose
from tltlc.automaton.finite.labels import LONGEST_SIMPLIFIED, Labels, LabelsTooLong
from tltlc.automaton.finite.machine import Machine, OutOfStates
from tltlc.automaton.finite.order import better_order, reorder, restore_order
from tltlc.automaton.finite.successors import Successors
from tltlc.automaton.fspa import Edge, Fspa, Guard, State, Verdict
from tltlc.automaton.guards import Guards, TooManyPrimes
from tltlc.automaton.transitions import IMPOSSIBLE, TransitionDiagrams
from tltlc.core.source import SourceFile, Span
from tltlc.expression.tree import SignalValue as SignalValue
from tltlc.io.limits import WORK
from tltlc.logic.formula import Formula, rebuild
from tltlc.logic.normal_form import negation_normal_form
from tltlc.logic.text.printer import ascii_text
from tltlc.resolve.spec import Atom, Signal, Spec

DEFAULT_STATE_BUDGET = 50_000


def build(spec: Spec, *, state_budget: int = DEFAULT_STATE_BUDGET) -> Fspa:
    """Return the minimal complete automaton of a spec over finite traces (``docs/semantics.md``, "The automaton").

    Raises :class:`~tltlc.diagnostics.diagnostic.TltlError`: TLT0502 if there are too many edges or
    prime implicants, and TLT0501 if anything else becomes too large, such as the number of states
    (``state_budget``) or the labels. Both errors point at the clauses that make the automaton
    large.
    """
    with recursion_room():
        try:
            return _build(spec, state_budget)
        except (OutOfStates, OutOfSteps, TooManyPrimes, LabelsTooLong, RecursionError) as reason:
            raise budget_error(spec, reason, state_budget) from None


def minimal_machine(
    formula: Formula,
    atoms: Sequence[str],
    state_budget: int,
    exclusive: Iterable[Sequence[int]] = (),
    diagrams: TransitionDiagrams | None = None,
) -> tuple[Successors, Machine, int]:
    """Return the minimal machine of a formula, as the second of three results.

    A machine is an automaton whose transitions, not states, decide acceptance. The first result is
    the :class:`Successors` in whose tables the states and transitions of the machine are numbered.
    The third is a guard that is true on the letters (sets of atoms) with at most one atom of each
    group in ``exclusive``. A group lists indices into ``atoms``.
    """
    normal = negation_normal_form(formula)
    diagrams = TransitionDiagrams() if diagrams is None else diagrams
    successors = Successors(atoms, diagrams)
    successors.number_variables(normal)
    allowed = diagrams.allowed_letters(exclusive)
    return successors, compose(successors, normal, state_budget, allowed), allowed


def _build(spec: Spec, state_budget: int) -> Fspa:
    """Build the automaton; if this takes too many steps, build it again with the atoms in another order.

    In the result, the atoms always have the order of the spec.
    """
    order = better_order(spec.formula, [atom.name for atom in spec.atoms])
    if order is None:
        return _build_in_order(spec, state_budget)
    try:
        return _build_in_order(spec, state_budget, WORK["steps in the given order of atoms"])
    except OutOfSteps:
        return restore_order(_build_in_order(reorder(spec, order), state_budget), spec, order)


def _build_in_order(spec: Spec, state_budget: int, steps: int | None = None) -> Fspa:
    """Build the automaton with the atoms in the order of the spec.

    Raises :class:`OutOfSteps` if the machine or the guards take more than ``steps`` steps (None:
    the default limit).
    """
    names = [atom.name for atom in spec.atoms]
    diagrams = TransitionDiagrams()

    def bounded_steps() -> AbstractContextManager[None]:
        return diagrams.limit.at_most(steps) if steps is not None else nullcontext()

    with bounded_steps():
        successors, minimal, allowed = minimal_machine(spec.formula, names, state_budget, spec.exclusive, diagrams)
    has_answers = any(register.kind == "due" for register in spec.registers)
    targets = _targets(minimal, diagrams, has_answers and _holds_before_samples(spec.formula))
    distance = distances(targets, accepting=lambda leaf: diagrams.value[leaf][1] == 1)
    order = breadth_first(next(iter(targets)), targets, distance)
    verdict = verdicts(targets, distance, accepting=lambda leaf: diagrams.value[leaf][1] == 1)
    labels = _labels(spec.formula, successors, minimal, order, allowed)

    states = tuple(
        State(
            id=number,
            label=labels[leaf],
            accepting=diagrams.value[leaf][1] == 1,
            verdict=verdict[leaf],
            distance=distance[leaf],
        )
        for number, leaf in enumerate(order)
    )
    with bounded_steps():
        edges = _edges(order, minimal, Guards(diagrams, names, allowed), diagrams)
    finite = [d for d in distance.values() if d is not None]
    return Fspa(
        name=spec.name,
        doc=spec.doc,
        formula=spec.formula,
        level=spec.level,
        limit_steps=spec.limit_steps,
        judge=spec.judge or (judge_of(spec.parts) if spec.parts else default_judge(spec.formula)),
        semantics=spec.semantics,
        tags=spec.tags,
        clock_s=spec.clock_s,
        clock_varies=spec.clock_varies,
        registers=spec.registers,
        signals=spec.signals,
        params=spec.params,
        atoms=spec.atoms,
        exclusive=spec.exclusive,
        states=states,
        edges=edges,
        spec_size=max(finite, default=0),
    )


# --- states ---------------------------------------------------------------------------------------
# A state of the automaton is a leaf of the machine: the obligation that remains, and whether the state is accepting.


def state_leaves(minimal: Machine, diagrams: TransitionDiagrams, accept: bool = False) -> list[int]:
    """Return the states of the automaton, the initial state first.

    Each state is a leaf of ``diagrams``: an obligation (what remains to be done), and whether the
    state accepts. Since no trace is empty, the initial state may accept or reject. It accepts if
    transitions lead back to the initial obligation, and all of them accept. These transitions then
    lead to the initial state, which saves a second state with the same obligation. If only some of them
    accept, there are two such states, and the initial state is the one that accepts if ``accept``.
    Otherwise the initial state rejects.
    """
    reached = diagrams.leaves(*minimal.transitions.values())
    rejecting, accepting = diagrams.leaf((minimal.initial, 0)), diagrams.leaf((minimal.initial, 1))
    initial = accepting if accepting in reached and (accept or rejecting not in reached) else rejecting
    return [initial, *(leaf for leaf in reached if leaf not in (initial, IMPOSSIBLE))]


def _holds_before_samples(formula: Formula) -> bool:
    """Whether a formula holds while there is no sample yet: ``G a`` does, ``F a`` and ``a`` do not."""
    done: dict[Formula, bool] = {}
    for node in negation_normal_form(formula).bottom_up():
        parts = [done[part] for part in node.args]
        if node.op in ("and", "or"):
            done[node] = all(parts) if node.op == "and" else any(parts)
        else:
            done[node] = node.op in ("true", "N", "G", "W", "R")
    return done[node]


def _targets(minimal: Machine, diagrams: TransitionDiagrams, accept: bool) -> dict[int, list[int]]:
    """Map each state to its successors; the initial state comes first. ``accept`` is as for :func:`state_leaves`.

    Raises :class:`TooManyPrimes` if there are more edges than ``WORK["edges"]``.
    """
    targets: dict[int, list[int]] = {}
    remaining = WORK["edges"]
    for leaf in state_leaves(minimal, diagrams, accept):
        reached = diagrams.leaves(minimal.transitions[diagrams.value[leaf][0]])
        targets[leaf] = [target for target in reached if target != IMPOSSIBLE]
        remaining -= len(targets[leaf])
        if remaining < 0:
            raise TooManyPrimes("the automaton", WORK["edges"], "edges")
    return targets


def distances(targets: Mapping[int, list[int]], accepting: Callable[[int], bool]) -> dict[int, int | None]:
    """Return the least number of transitions from each state to an accepting state, None for traps.

    ``targets`` maps each state to its successors.
    """
    sources: dict[int, list[int]] = {state: [] for state in targets}
    for state, successors in targets.items():
        for target in successors:
            sources[target].append(state)
    distance: dict[int, int | None] = dict.fromkeys(targets)
    queue = [state for state in targets if accepting(state)]
    for state in queue:
        distance[state] = 0
    for state in queue:
        for source in sources[state]:
            if distance[source] is None:
                distance[source] = (distance[state] or 0) + 1
                queue.append(source)
    return distance


def breadth_first(initial: int, targets: Mapping[int, list[int]], distance: Mapping[int, int | None]) -> list[int]:
    """Return the states that ``initial`` can reach, in breadth-first order.

    ``targets`` maps each state to its successors. They are visited in order of their distance to an
    accepting state, traps last. Successors with the same distance are visited in the order of the
    keys of ``targets``.
    """
    position = {state: index for index, state in enumerate(targets)}

    def rank(state: int) -> tuple[bool, int, int]:
        d = distance[state]
        return d is None, d or 0, position[state]

    order = [initial]
    seen = {initial}
    for state in order:
        for target in sorted(targets[state], key=rank):
            if target not in seen:
                seen.add(target)
                order.append(target)
    return order


def verdicts(
    targets: Mapping[int, list[int]], distance: Mapping[int, int | None], accepting: Callable[[int], bool]
) -> dict[int, Verdict]:
    """Return the verdict of each state.

    The verdict is ``satisfied`` if no rejecting state can be reached, and ``violated`` if no
    accepting state can be reached. Otherwise it is ``holding`` for accepting states, and
    ``pending`` for rejecting states.
    """
    to_rejection = distances(targets, lambda state: not accepting(state))

    def verdict(state: int) -> Verdict:
        if distance[state] is None:
            return "violated"
        if to_rejection[state] is None:
            return "satisfied"
        return "holding" if accepting(state) else "pending"

    return {state: verdict(state) for state in targets}


def _edges(order: Sequence[int], minimal: Machine, guards: Guards, diagrams: TransitionDiagrams) -> tuple[Edge, ...]:
    number = {leaf: index for index, leaf in enumerate(order)}
    guard_of: dict[int, Guard] = {}
    edges: list[Edge] = []
    for source, leaf in enumerate(order):
        for target, guard in guards.by_leaf(minimal.transitions[diagrams.value[leaf][0]]).items():
            if guard not in guard_of:
                guard_of[guard] = Guard(guards.formula(guard), guards.primes(guard))
            edges.append(Edge(source, number[target], guard_of[guard]))
    return tuple(sorted(edges, key=lambda edge: (edge.source, edge.target)))


# --- labels ---------------------------------------------------------------------------------------


def _labels(
    source: Formula, successors: Successors, minimal: Machine, order: Sequence[int], allowed: int
) -> dict[int, Formula]:
    """Return the label of every state, with the operators of the source (``a -> b``, not ``!a | b``).

    Raises :class:`LabelsTooLong` if all labels together have more operators and atoms than
    ``WORK["label nodes"]``.
    """
    diagrams = successors.diagrams
    labels = Labels(successors, minimal, negation_normal_form(source), allowed)
    restored = _arrow_forms(source, labels)
    formulas: dict[int, Formula] = {}
    remaining = WORK["label nodes"]
    own = labels.simplify_label(source)
    for state in minimal.transitions:
        formula = _restore_arrows(labels.label(state), restored)
        formulas[state] = own if state == minimal.initial and labels.size(own) <= labels.size(formula) else formula
        remaining -= labels.size(formulas[state])
        if remaining < 0:
            raise LabelsTooLong
    value = diagrams.value
    return {leaf: formulas[value[leaf][0]] for leaf in order}


def _arrow_forms(source: Formula, labels: Labels) -> dict[Formula, Formula]:
    """Map the negation normal form of each ``->`` and ``<->`` in the source to the subformula as written.

    For example, ``!a | b`` is mapped to ``a -> b``. Subformulas of more than
    :data:`~tltlc.automaton.finite.labels.LONGEST_SIMPLIFIED` operators and atoms are left out. The
    largest others are left out too, until all together have at most ``WORK["arrow nodes"]``
    operators and atoms.
    """
    parts = [part for part in source.walk() if part.op in ("implies", "iff")]
    remaining = WORK["arrow nodes"]
    written: dict[Formula, Formula] = {}
    for part in sorted(parts, key=labels.size):
        remaining -= labels.size(part)
        if remaining < 0 or labels.size(part) > LONGEST_SIMPLIFIED:
            break
        written[negation_normal_form(part)] = part
    return written


def _restore_arrows(formula: Formula, restored: dict[Formula, Formula]) -> Formula:
    """Return the formula with ``->`` and ``<->`` wherever the source has them.

    ``restored`` is the result of :func:`_arrow_forms`. This function caches its own results in the
    same dict.
    """
    for node in formula.bottom_up(known=restored):
        restored[node] = rebuild(node, tuple(restored[argument] for argument in node.args))
    return restored[formula]


# --- specs without a file -------------------------------------------------------------------------


def spec_from_formula(formula: Formula, name: str = "spec", exclusive: Iterable[Iterable[str]] = ()) -> Spec:
    """Return a spec over finite traces with this formula.

    The value of each atom is the value of a signal with the same name and the range [-1, 1].
    ``exclusive`` has groups of names of atoms that never hold together.
    """
    groups = [tuple(group) for group in exclusive]
    names = tuple(dict.fromkeys((*formula.atoms(), *(atom for group in groups for atom in group))))
    return Spec(
        name=name,
        doc="",
        formula=formula,
        parts=(),
        atoms=tuple(Atom(atom, SignalValue(atom)) for atom in names),
        signals=tuple(Signal(atom, "number", -1.0, 1.0) for atom in names),
        params=(),
        exclusive=tuple(tuple(names.index(atom) for atom in group) for group in groups),
        level=None,
        limit_steps=None,
        judge=None,
        semantics="finite",
        tags=(),
        clock_s=None,
        source=SourceFile("<formula>", ascii_text(formula), "text"),
        name_span=Span(0, 0),
    )
