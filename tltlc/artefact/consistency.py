"""Check what the schema of artefacts cannot express: that the parts of an artefact agree with each other."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Final, Union

from tltlc.artefact.guards import guard_problems
from tltlc.artefact.locations import JsonPath
from tltlc.automaton.fspa import Fspa, Verdict
from tltlc.core.record import record
from tltlc.expression.tree import AtomValue, Before, ParamValue, SignalValue, StepLength, nodes
from tltlc.resolve import spec

Declared = Union[spec.Signal, spec.Param, spec.Atom]

CYCLES_WORK: Final = 1_000_000
"""The most steps of work for the check of accepting states and verdicts over infinite traces.

Large automata with many cycles need more steps. Their accepting states and verdicts are not checked.
"""


@record
class Problem:
    """A contradiction in an artefact: the path of the wrong value in the JSON document, and a message."""

    path: JsonPath
    message: str


def problems(fspa: Fspa) -> Iterator[Problem]:
    """Yield the contradictions in an automaton that was read from an artefact.

    There are nine checks. Later checks rely on earlier ones, so all contradictions come from the first
    check that finds any. Two checks have a limit on their work, so large automata are checked only in
    part:

    - the check of guards (:data:`tltlc.artefact.guards.WORK_LIMIT`);
    - over infinite traces, the check of accepting states and verdicts (:data:`CYCLES_WORK`).
    """
    for check in (_names, _clock, _values, _indices, _clauses, _parallel_edges, _numbering, _distances, _guards):
        failed = False
        for problem in check(fspa):
            failed = True
            yield problem
        if failed:
            return


def _names(fspa: Fspa) -> Iterator[Problem]:
    """Check that names are unique, and that expressions use only declared names."""
    declared: dict[str, Sequence[Declared]] = {"signals": fspa.signals, "params": fspa.params, "atoms": fspa.atoms}
    known: dict[str, set[str]] = {}
    for kind, items in declared.items():
        known[kind] = set()
        for index, item in enumerate(items):
            if item.name in known[kind]:
                yield Problem((kind, index, "name"), f"two {kind} are named `{item.name}`")
            known[kind].add(item.name)
    registers = {register.name for register in fspa.registers}
    for index, atom in enumerate(fspa.atoms):
        path: JsonPath = ("atoms", index, "expression")
        for node in nodes(atom.expression):
            if isinstance(node, SignalValue) and node.name not in known["signals"] | registers:
                yield Problem(path, f"there is no signal `{node.name}`")
            elif isinstance(node, ParamValue) and node.name not in known["params"]:
                yield Problem(path, f"there is no param `{node.name}`")
            elif isinstance(node, (AtomValue, Before, StepLength)):
                yield Problem(path, "only the update of a register reads atoms, registers before, and the step length")
    yield from _registers(fspa, known)


def _registers(fspa: Fspa, known: Mapping[str, set[str]]) -> Iterator[Problem]:
    """Check that the updates of registers use only declared names, and registers and atoms that are computed before."""
    everywhere, earlier = {register.name for register in fspa.registers}, set[str]()
    reads = {
        atom.name: {node.name for node in nodes(atom.expression) if isinstance(node, SignalValue)}
        for atom in fspa.atoms
    }
    for index, register in enumerate(fspa.registers):
        path: JsonPath = ("registers", index, "update")
        if register.name in earlier or register.name in known["signals"]:
            yield Problem(("registers", index, "name"), f"two signals or registers are named `{register.name}`")
        for node in nodes(register.update):
            if isinstance(node, SignalValue) and node.name not in known["signals"] | earlier:
                yield Problem(path, f"there is no signal and no earlier register `{node.name}`")
            elif isinstance(node, ParamValue) and node.name not in known["params"]:
                yield Problem(path, f"there is no param `{node.name}`")
            elif isinstance(node, Before) and node.name not in everywhere:
                yield Problem(path, f"there is no register `{node.name}`")
            elif isinstance(node, AtomValue) and node.name not in known["atoms"]:
                yield Problem(path, f"there is no atom `{node.name}`")
            elif isinstance(node, AtomValue) and not reads[node.name] & everywhere <= earlier:
                yield Problem(path, f"the atom `{node.name}` reads a register that comes later")
        earlier.add(register.name)


def _clock(fspa: Fspa) -> Iterator[Problem]:
    """Check that registers count time as the clock says: in seconds if it varies, else in steps."""
    path: JsonPath = ("spec", "clock_varies")
    if fspa.clock_varies and fspa.clock_s is not None:
        yield Problem(path, "the clock varies, so it has no `clock_s`")
    for index, register in enumerate(fspa.registers):
        reads_length = any(isinstance(node, StepLength) for node in nodes(register.update))
        if reads_length and not fspa.clock_varies:
            message = f"`{register.name}` reads the length of a step, but the clock does not vary"
            yield Problem(("registers", index, "update"), message)
        if register.unit == "steps" and fspa.clock_varies:
            message = f"`{register.name}` counts steps as a time, but the clock varies"
            yield Problem(("registers", index, "unit"), message)


def _values(fspa: Fspa) -> Iterator[Problem]:
    """Check that ranges are not empty, and that the values of params lie in their ranges."""
    for index, signal in enumerate(fspa.signals):
        if signal.low is not None and signal.high is not None and signal.low > signal.high:
            yield Problem(("signals", index, "range"), f"the range of `{signal.name}` is empty")
        if signal.values and (signal.type, signal.low, signal.high) != ("int", 0.0, len(signal.values) - 1.0):
            message = f"`{signal.name}` is an enum, so it is an int from 0 to {len(signal.values) - 1}"
            yield Problem(("signals", index, "values"), message)
    for index, param in enumerate(fspa.params):
        low = param.value if param.low is None else param.low
        high = param.value if param.high is None else param.high
        if not low <= param.value <= high:
            yield Problem(("params", index, "value"), f"the value of `{param.name}` lies outside its range")
    for index, register in enumerate(fspa.registers):
        low = register.initial if register.low is None else register.low
        high = register.initial if register.high is None else register.high
        if not low <= register.initial <= high:
            yield Problem(("registers", index, "initial"), f"the value of `{register.name}` lies outside its range")


def _indices(fspa: Fspa) -> Iterator[Problem]:
    """Check that every index is in range, that the ids of states count from 0, and that edges are sorted."""
    states, atoms = len(fspa.states), len(fspa.atoms)
    for index, state in enumerate(fspa.states):
        if state.id != index:
            yield Problem(("states", index, "id"), f"state {index} has the id {state.id}")
    for index, group in enumerate(fspa.exclusive):
        if any(atom >= atoms for atom in group):
            yield Problem(("exclusive", index), _only(atoms, "atom"))
    previous = (-1, -1)
    for index, edge in enumerate(fspa.edges):
        for end, state_index in (("source", edge.source), ("target", edge.target)):
            if state_index >= states:
                yield Problem(("edges", index, end), f"there is no state {state_index}")
        if (edge.source, edge.target) < previous:
            yield Problem(("edges", index), "the edges are not sorted by source and target")
        previous = (edge.source, edge.target)
        for prime in edge.guard.primes:
            if any(atom >= atoms for atom, _ in prime):
                yield Problem(("edges", index, "guard", "primes"), _only(atoms, "atom"))
    for index, pair in enumerate(fspa.acceptance):
        for kind, edges in (("fin", pair.fin), ("inf", pair.inf)):
            if any(edge >= len(fspa.edges) for edge in edges):
                yield Problem(("acceptance", "pairs", index, kind), _only(len(fspa.edges), "edge"))


def _only(count: int, noun: str) -> str:
    return f"there {'is' if count == 1 else 'are'} only {count} {noun}{'s' * (count != 1)}"


def _parallel_edges(fspa: Fspa) -> Iterator[Problem]:
    """Check that no edge occurs twice.

    Two edges with the same source and target may differ only in the ``fin`` and ``inf`` sets of the
    Rabin pairs that contain them. Over finite traces there are no Rabin pairs, so at most one edge may
    lead from one state to another.
    """
    marks = fspa.marks()
    seen: set[tuple[object, ...]] = set()
    for index, edge in enumerate(fspa.edges):
        key = (edge.source, edge.target, marks[index])
        if key in seen:
            alike = " that are in the same `fin` and `inf` sets" if fspa.semantics == "infinite" else ""
            message = f"two edges{alike} lead from state {edge.source} to state {edge.target}"
            yield Problem(("edges", index), message)
        seen.add(key)


def _clauses(fspa: Fspa) -> Iterator[Problem]:
    """Check that the clauses that edges break exist, with atoms that exist."""
    for index, edge in enumerate(fspa.edges):
        for place, broken in enumerate(edge.broken):
            path = ("edges", index, "broken", place)
            if broken.clause >= len(fspa.clauses):
                yield Problem((*path, "clause"), f"there is no clause {broken.clause}")
            if any(atom >= len(fspa.atoms) for prime in broken.primes for atom, _ in prime):
                yield Problem((*path, "primes"), "an implicant has an atom that does not exist")


def _numbering(fspa: Fspa) -> Iterator[Problem]:
    """Check that states are numbered breadth-first.

    The parent of a state is the lowest state with an edge to it. In breadth-first order, a parent
    has a lower number than its child, and the parents of states 1, 2, 3, … never decrease.
    """
    parents = [len(fspa.states)] * len(fspa.states)
    for edge in fspa.edges:
        parents[edge.target] = min(parents[edge.target], edge.source)
    turn = 0
    for state in range(1, len(fspa.states)):
        if parents[state] >= state:
            yield Problem(("states", state), f"state {state} cannot be reached from a state before it")
        elif parents[state] < turn:
            yield Problem(("states", state), "the states are not numbered breadth-first")
        else:
            turn = parents[state]


def _distances(fspa: Fspa) -> Iterator[Problem]:
    """Check that distances, verdicts and ``spec_size`` follow from the accepting states and the edges.

    Over infinite traces, also check that the accepting states are those on accepted cycles: cycles that
    satisfy a Rabin pair.
    """
    goals, verdicts = _by_cycles(fspa) if fspa.semantics == "infinite" else _by_states(fspa)
    to_goal = _steps_to(fspa, goals)
    for state in fspa.states:
        if state.accepting != (state.id in goals):
            lies, accepts = ("is not", "is") if state.accepting else ("is", "is not")
            message = f"state {state.id} {lies} on an accepted cycle, but {accepts} accepting"
            yield Problem(("states", state.id, "accepting"), message)
        distance = to_goal.get(state.id)
        if state.distance != distance:
            yield Problem(
                ("states", state.id, "distance"),
                f"the distance of state {state.id} is {_json_text(distance)}, not {_json_text(state.distance)}",
            )
        verdict = verdicts[state.id]
        if state.verdict != verdict:
            yield Problem(
                ("states", state.id, "verdict"),
                f"the verdict of state {state.id} is `{verdict}`, not `{state.verdict}`",
            )
    size = max(to_goal.values(), default=0)
    if fspa.spec_size != size:
        yield Problem(("spec_size",), f"spec_size is {size}, not {fspa.spec_size}")


def _by_states(fspa: Fspa) -> tuple[Collection[int], list[Verdict]]:
    """Return the accepting states, and the right verdict of each state, for an automaton over finite traces."""
    goals = [state.id for state in fspa.states if state.accepting]
    to_goal = _steps_to(fspa, goals)
    to_failure = _steps_to(fspa, (state.id for state in fspa.states if not state.accepting))
    return goals, [_verdict(state.accepting, to_goal.get(state.id), to_failure.get(state.id)) for state in fspa.states]


def _by_cycles(fspa: Fspa) -> tuple[Collection[int], list[Verdict]]:
    """Return the states on accepted cycles, and the right verdict of each state, for infinite traces.

    If the analysis takes too much work, return the accepting states and verdicts of the artefact
    instead, unchecked.
    """
    from tltlc.automaton.infinite.analysis import analysis_of_fspa
    from tltlc.automaton.work import OutOfWork, Work

    try:
        analysis = analysis_of_fspa(fspa, Work(CYCLES_WORK))
    except OutOfWork:
        return [state.id for state in fspa.states if state.accepting], [state.verdict for state in fspa.states]
    return analysis.goals, [analysis.verdict(state.id) for state in fspa.states]


def _steps_to(fspa: Fspa, goals: Iterable[int]) -> dict[int, int]:
    """Map each state to the least number of transitions to one of ``goals``.

    States that reach no goal are left out.
    """
    into: list[list[int]] = [[] for _ in fspa.states]
    for edge in fspa.edges:
        into[edge.target].append(edge.source)
    steps = dict.fromkeys(goals, 0)
    queue = list(steps)
    for state in queue:
        for source in into[state]:
            if source not in steps:
                steps[source] = steps[state] + 1
                queue.append(source)
    return steps


def _verdict(accepting: bool, to_goal: int | None, to_failure: int | None) -> Verdict:
    if accepting:
        return "satisfied" if to_failure is None else "holding"
    return "violated" if to_goal is None else "pending"


def _json_text(distance: int | None) -> str:
    return "null" if distance is None else str(distance)


def _guards(fspa: Fspa) -> Iterator[Problem]:
    for path, message in guard_problems(fspa):
        yield Problem(path, message)
