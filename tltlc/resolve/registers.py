"""Registers, the memory of a monitor: how each is updated, and which of them the atoms of a spec need.

``docs/semantics.md``, "Memory", defines every register as a function of the trace so far. The updates
below compute the same values from one sample to the next.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from tltlc.core.record import record
from tltlc.expression.tree import (
    LEAST,
    AtomValue,
    Before,
    Condition,
    Const,
    Expression,
    Op,
    SignalValue,
    StepLength,
    When,
    nodes,
)
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import Atom, Register, RegisterKind

SAMPLES: Final = "samples so far"
"""The name of the register that counts the samples so far."""

FIRST: Final = "first sample"
"""The name of the register that is 1 before the first sample, and 0 from then on."""

ELAPSED: Final = "time so far"
"""The name of the register with the time from the first sample to this one."""

COUNTS: Final[tuple[RegisterKind, ...]] = ("times", "times_since", "times_within")
"""The kinds of registers that count how often a formula has begun."""

SATURATING: Final[tuple[RegisterKind, ...]] = (
    "times",
    "time_since",
    "time_holding",
    "times_since",
    "total_time",
    "total_time_since",
    "times_within",
    "begun",
    "samples",
    "elapsed",
    "run",
    "age",
    "waiting",
)
"""The kinds of registers that stop at a maximum, which depends on the comparisons of a spec."""


@record
class RegisterDraft:
    """A register without its maximum. ``update`` has no maximum, either, and may exceed it by one step."""

    name: str
    kind: RegisterKind
    unit: str
    low: float | None
    high: float | None
    initial: float
    update: Expression

    def with_maximum(self, maximum: float) -> Register:
        """Return the register, which stops at ``maximum`` if it is of a kind that saturates."""
        if self.kind not in SATURATING:
            return Register(self.name, self.kind, self.unit, self.low, self.high, self.initial, self.update)
        initial = maximum if self.kind in ("time_since", "age", "begun") else self.initial
        update = Op("min", (self.update, Const(maximum)))
        return Register(self.name, self.kind, self.unit, self.low, maximum, initial, update)


# --- updates --------------------------------------------------------------------------------------


def once(name: str, operand: Expression) -> RegisterDraft:
    """Return the register of ``once p``: the greatest robustness of p so far."""
    return RegisterDraft(name, "once", "", -1.0, 1.0, -1.0, Op("max", (Before(name), operand)))


def historically(name: str, operand: Expression) -> RegisterDraft:
    """Return the register of ``historically p``: the least robustness of p so far."""
    return RegisterDraft(name, "historically", "", -1.0, 1.0, 1.0, Op("min", (Before(name), operand)))


def since(name: str, left: Expression, right: Expression) -> RegisterDraft:
    """Return the register of ``p since q``: q now, or p now and ``p since q`` before."""
    update = Op("max", (right, Op("min", (left, Before(name)))))
    return RegisterDraft(name, "since", "", -1.0, 1.0, -1.0, update)


def last(name: str, operand: Expression, low: float | None, high: float | None, initial: float) -> RegisterDraft:
    """Return the register that keeps the value of an expression for the next sample."""
    return RegisterDraft(name, "last", "", low, high, initial, operand)


def previously(name: str, kept: str) -> RegisterDraft:
    """Return the register of ``previously p``: the robustness of p at the sample before, -1 at the first sample.

    ``kept`` is the register that keeps the robustness of p.
    """
    return RegisterDraft(name, "previously", "", -1.0, 1.0, -1.0, Before(kept))


def begins(operand: Condition, kept: str) -> Condition:
    """Return the condition that p begins at this sample; ``kept`` is the register that keeps its robustness."""
    return Condition("and", (operand, Condition("not", (holds(Before(kept)),))))


def times(name: str, operand: Condition, kept: str) -> RegisterDraft:
    """Return the register of ``times(p)``: at how many samples p has begun to hold."""
    more = Op("+", (Before(name), Const(1.0)))
    return RegisterDraft(name, "times", "", 0.0, None, 0.0, When(((begins(operand, kept), more),), Before(name)))


def times_since(name: str, operand: Condition, kept: str, event: Condition) -> RegisterDraft:
    """Return the register of ``times_since(p, q)``: how often p has begun since the last sample with q, with this one.

    ``kept`` is the register that keeps the robustness of p, and ``event`` the truth of q. Before the
    first q, p is counted from the first sample on.
    """
    begun = begins(operand, kept)
    cases: tuple[tuple[Condition, Expression], ...] = (
        (Condition("and", (event, begun)), Const(1.0)),
        (event, Const(0.0)),
        (begun, Op("+", (Before(name), Const(1.0)))),
    )
    return RegisterDraft(name, "times_since", "", 0.0, None, 0.0, When(cases, Before(name)))


def time_since(name: str, operand: Condition, step: Expression, unit: str) -> RegisterDraft:
    """Return the register of ``time_since(p)``: 0 where p holds, else one step more than before."""
    update = When(((operand, Const(0.0)),), Op("+", (Before(name), step)))
    return RegisterDraft(name, "time_since", unit, 0.0, None, 0.0, update)


def time_holding(name: str, operand: Condition, kept: str, step: Expression, unit: str) -> RegisterDraft:
    """Return the register of ``time_holding(p)``: the time from the sample at which p began to hold until now."""
    both = Condition("and", (operand, holds(Before(kept))))
    update = When(((both, Op("+", (Before(name), step))),), Const(0.0))
    return RegisterDraft(name, "time_holding", unit, 0.0, None, 0.0, update)


def total_time(name: str, operand: Condition, step: Expression, unit: str) -> RegisterDraft:
    """Return the register of ``total_time(p)``: the lengths of all samples with p together."""
    return RegisterDraft(name, "total_time", unit, 0.0, None, 0.0, added(operand, Before(name), step))


def added(operand: Condition, before: Expression, step: Expression) -> Expression:
    """Return a time ``before`` this sample and, if p holds, the length of its step."""
    return When(((operand, Op("+", (before, step))),), before)


def total_time_since(name: str, operand: Condition, event: Condition, step: Expression, unit: str) -> RegisterDraft:
    """Return the register of ``total_time_since(p, q)``: the lengths of the samples with p since the last q.

    ``event`` is the truth of q. The sample with q counts, and before the first q, all samples do.
    """
    cases: tuple[tuple[Condition, Expression], ...] = (
        (Condition("and", (event, operand)), step),
        (event, Const(0.0)),
        (operand, Op("+", (Before(name), step))),
    )
    return RegisterDraft(name, "total_time_since", unit, 0.0, None, 0.0, When(cases, Before(name)))


def samples() -> RegisterDraft:
    """Return the register that counts the samples so far."""
    return RegisterDraft(SAMPLES, "samples", "steps", 0.0, None, 0.0, Op("+", (Before(SAMPLES), Const(1.0))))


def elapsed() -> RegisterDraft:
    """Return the register with the time from the first sample to this one; it is -1 before the first sample."""
    begun = Condition("<", (Before(ELAPSED), Const(0.0)))
    update = When(((begun, Const(0.0)),), Op("+", (Before(ELAPSED), StepLength())))
    return RegisterDraft(ELAPSED, "elapsed", "s", -1.0, None, -1.0, update)


def run(name: str, kept: str) -> RegisterDraft:
    """Return the register with the time from the start of the last run of samples with p to this sample.

    This run includes the sample before. If p did not hold there, the time is 0. ``kept`` is the register
    that keeps the robustness of p.
    """
    update = When(((holds(Before(kept)), Op("+", (Before(name), StepLength()))),), Const(0.0))
    return RegisterDraft(name, "run", "s", 0.0, None, 0.0, update)


def age(name: str, kept: str, step: Expression, unit: str) -> RegisterDraft:
    """Return the register with the time from the latest sample before this one at which p held.

    ``kept`` is the register that keeps the robustness of p.
    """
    update = When(((holds(Before(kept)), step),), Op("+", (Before(name), step)))
    return RegisterDraft(name, "age", unit, 0.0, None, 0.0, update)


def due(name: str, request: Expression, goal: Expression, strict: bool) -> RegisterDraft:
    """Return the register that is above 0 while a request waits for its goal; it is the robustness of that.

    If ``strict``, the goal must come after the request, at a later sample.
    """
    waits = When(((holds(Before(name)), Const(1.0)),), Const(-1.0))
    missed = negated(goal)
    if strict:
        update = Op("max", (Op("min", (missed, waits)), request))
    else:
        update = Op("min", (missed, Op("max", (request, waits))))
    return RegisterDraft(name, "due", "", -1.0, 1.0, -1.0, update)


def breach(name: str, value: Expression) -> RegisterDraft:
    """Return the register with the robustness of "a rule is broken" at this sample."""
    return RegisterDraft(name, "breach", "", -1.0, 1.0, -1.0, value)


def waiting(name: str, request: Condition, goal: Condition, strict: bool, step: Expression) -> RegisterDraft:
    """Return the register with the age of the oldest request that waits for its goal, plus one step.

    It is 0 if no request waits.
    """
    older = (Condition(">", (Before(name), Const(0.0))), Op("+", (Before(name), step)))
    new = (request, Const(1.0))
    if strict:
        older = (Condition("and", (older[0], Condition("not", (goal,)))), older[1])
        cases: tuple[tuple[Condition, Expression], ...] = (older, new)
    else:
        cases = ((goal, Const(0.0)), older, new)
    return RegisterDraft(name, "waiting", "steps", 0.0, None, 0.0, When(cases, Const(0.0)))


def waiting_time(name: str, request: Condition, goal: Condition, deadline_s: float) -> RegisterDraft:
    """Return the register with the time since the oldest request that waits for its goal; -1 if none waits.

    A request that has waited for more than ``deadline_s`` seconds waits for ever, even if its goal comes now.
    """
    waits = Condition("not", (Condition("<", (Before(name), Const(0.0))),))
    now = Op("+", (Before(name), StepLength()))
    late = Condition("and", (waits, Condition(">", (now, Const(deadline_s)))))
    cases = ((late, now), (goal, Const(-1.0)), (waits, now), (request, Const(0.0)))
    return RegisterDraft(name, "waiting", "s", -1.0, None, -1.0, When(cases, Const(-1.0)))


def first() -> RegisterDraft:
    """Return the register that is 1 before the first sample, and 0 from then on."""
    return RegisterDraft(FIRST, "first", "", 0.0, 1.0, 1.0, Const(0.0))


def at_first(value: Expression, otherwise: Expression) -> Expression:
    """Return ``value`` at the first sample, and ``otherwise`` at all others."""
    return When(((holds(Before(FIRST)), value),), otherwise)


def step_length(varies: bool) -> Expression:
    """Return the length of a step in the unit of the registers that count time: seconds, or steps on a fixed clock."""
    return StepLength() if varies else Const(1.0)


def sample_length(varies: bool) -> Expression:
    """Return the time from the sample before, in the unit of :func:`step_length`; 0 at the first sample."""
    return at_first(Const(0.0), step_length(varies))


# --- formulas as expressions ------------------------------------------------------------------------


def robustness(formula: Formula) -> Expression:
    """Return the robustness of a formula without temporal operators, as an expression over its atoms.

    Its value is above 0 exactly where the formula is true, even where the robustness of an atom is 0.
    """
    done: dict[tuple[Formula, bool], Expression] = {}
    for node in formula.bottom_up():
        for positive in (True, False):
            done[node, positive] = _robustness(node, positive, done)
    return done[formula, True]


def _robustness(node: Formula, positive: bool, done: Mapping[tuple[Formula, bool], Expression]) -> Expression:
    if node.op in ("true", "false"):
        return Const(1.0 if (node.op == "true") == positive else -1.0)
    if node.op == "atom":
        value = AtomValue(node.name)
        return value if positive else negated(value)
    if node.op == "not":
        return done[node.args[0], not positive]
    if node.op in ("and", "or"):
        return Op("min" if (node.op == "and") == positive else "max", tuple(done[part, positive] for part in node.args))
    left, right = node.args
    if node.op == "implies":
        return Op("max" if positive else "min", (done[left, not positive], done[right, positive]))
    assert node.op == "iff", "past operators take formulas without temporal operators"
    alike, unlike = (done[left, True], done[right, positive]), (done[left, False], done[right, not positive])
    return Op("max", (Op("min", alike), Op("min", unlike)))


def truth(formula: Formula) -> Condition:
    """Return the condition that a formula without temporal operators is true, over the values of its atoms."""
    done: dict[Formula, Condition] = {}
    for node in formula.bottom_up():
        parts = tuple(done[part] for part in node.args)
        if node.op in ("true", "false"):
            done[node] = holds(Const(1.0 if node.op == "true" else -1.0))
        elif node.op == "atom":
            done[node] = holds(AtomValue(node.name))
        elif node.op == "implies":
            done[node] = Condition("or", (Condition("not", parts[:1]), parts[1]))
        elif node.op == "iff":
            neither = Condition("not", (Condition("or", parts),))
            done[node] = Condition("or", (Condition("and", parts), neither))
        else:
            done[node] = Condition(node.op, parts)  # type: ignore[arg-type]
    return done[formula]


def negated(value: Expression) -> Expression:
    """Return ``-value``, but a number above 0 where ``value`` is 0: there the negation is true."""
    opposite = Op("neg", (value,))
    return When(((holds(value), opposite),), Op("max", (opposite, Const(LEAST))))


def holds(value: Expression) -> Condition:
    """Return the condition that a robustness is above 0."""
    return Condition(">", (value, Const(0.0)))


# --- the registers of a spec ------------------------------------------------------------------------


@record
class Memory:
    """What the atoms of a spec remember: ``registers``, and the further ``atoms`` that these read."""

    registers: tuple[Register, ...]
    atoms: tuple[Atom, ...]


def memory_of(atoms: Iterable[Atom], drafts: Mapping[str, RegisterDraft], known: Mapping[str, Atom]) -> Memory:
    """Return the registers that the atoms read, directly or through other registers, and their atoms.

    ``drafts`` are all registers by name, and ``known`` all atoms by name. Each register comes after
    those that it reads at the same sample; apart from that, registers and further atoms are in order of
    first use, whatever other specs remember. The maximum of a register is the greatest that any
    comparison asks for.
    """
    found = {atom.name: atom for atom in atoms}
    given = tuple(found)
    maxima: dict[str, float] = {}
    registers: list[str] = []
    seen: set[tuple[type, str]] = set()

    def reads(expression: Expression) -> Iterator[Expression | Condition]:
        for name, maximum in _maxima(expression, drafts):
            maxima[name] = max(maximum, maxima.get(name, 0.0))
        return nodes(expression)

    # A walk in depth; each entry has the parts still to visit, and the register whose update they are.
    walk: list[tuple[Iterator[Expression | Condition], str | None]] = [(iter(map(AtomValue, given)), None)]
    while walk:
        parts, register = walk[-1]
        for node in parts:
            if isinstance(node, AtomValue) and (AtomValue, node.name) not in seen:
                seen.add((AtomValue, node.name))
                atom = found.setdefault(node.name, known[node.name])
                walk.append((reads(atom.expression), None))
                break
            if isinstance(node, (SignalValue, Before)) and node.name in drafts and (Before, node.name) not in seen:
                seen.add((Before, node.name))
                walk.append((reads(drafts[node.name].update), node.name))
                break
        else:
            walk.pop()
            if register is not None:
                registers.append(register)
    further = tuple(found[name] for name in found if name not in given)
    return Memory(tuple(drafts[name].with_maximum(maxima.get(name, 0.0)) for name in registers), further)


def saturated(register: str, maximum: float) -> Expression:
    """Return the value of a register that saturates, up to a maximum."""
    return Op("min", (SignalValue(register), Const(float(maximum))))


def _maxima(expression: Expression, drafts: Mapping[str, RegisterDraft]) -> Iterator[tuple[str, float]]:
    """Yield the name and the maximum of each :func:`saturated` register that an expression reads."""
    for node in nodes(expression):
        if isinstance(node, Op) and node.op == "min" and isinstance(node.args[0], SignalValue):
            draft, maximum = drafts.get(node.args[0].name), node.args[1]
            if draft is not None and draft.kind in SATURATING and isinstance(maximum, Const):
                yield draft.name, maximum.value


def following_atoms(atoms: Iterable[Atom], registers: Iterable[Register]) -> frozenset[str]:
    """Return the names of the atoms that follow from the other atoms at this sample and those before.

    ``times(seen) > 3`` follows from ``seen``.
    """
    known = from_atoms(registers)
    return frozenset(atom.name for atom in atoms if (read := _names_read(atom.expression)) and read <= known)


def from_atoms(registers: Iterable[Register]) -> frozenset[str]:
    """Return the names of the registers whose values follow from the values of the atoms so far."""
    names: set[str] = set()
    for register in registers:
        if _names_read(register.update) <= names:
            names.add(register.name)
    return frozenset(names)


def _names_read(expression: Expression) -> set[str]:
    """Return the names of the signals and registers that an expression reads."""
    return {node.name for node in nodes(expression) if isinstance(node, SignalValue)}
