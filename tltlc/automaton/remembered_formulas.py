"""The formulas that registers remember, read back from their updates.

The updates are those of :mod:`tltlc.resolve.registers`, which turns a formula into its truth or its
robustness; this module does the reverse.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import NamedTuple, cast

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import breaches_now
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import (
    AtomValue,
    Before,
    Condition,
    Const,
    Expression,
    Op,
    ParamValue,
    SignalValue,
    When,
    nodes,
)
from tltlc.logic.boolean_rules import drop_constants
from tltlc.logic.formula import FALSE, TRUE, Formula, always, and_, atom, eventually, iff, implies, not_, or_, rebuild
from tltlc.logic.normal_form import negation_normal_form
from tltlc.resolve.spec import Atom, Register


class Answer(NamedTuple):
    """What a register of an answer waits for: ``goal``, after ``request``; if ``strict``, at a later sample."""

    request: Formula
    goal: Formula
    strict: bool


def names_read(item: Atom) -> set[str]:
    """Return the names of the signals, params and registers that an atom reads."""
    return {node.name for node in nodes(item.expression) if isinstance(node, (SignalValue, ParamValue))}


def counted(register: Register, registers: Mapping[str, Register]) -> Formula | None:
    """Return the formula that a count, or a time since it held or began to hold, is about; None for other registers."""
    update = register.update.args[0] if isinstance(register.update, Op) else register.update
    if not isinstance(update, When):
        return None
    condition = update.cases[0][0]
    if register.kind in ("times_since", "total_time_since"):
        condition = update.cases[-1][0]
    if register.kind == "times_within":
        # The last case asks for the age of the last beginning.
        ages = [node.name for node in nodes(update.cases[-1][0]) if isinstance(node, SignalValue)]
        return counted(registers[ages[0]], registers)
    if register.kind in ("age", "run"):
        kept = condition.args[0]
        return remembered(kept.name, registers) if isinstance(kept, Before) else None
    if register.kind in ("times", "times_since", "begun", "time_holding"):
        # The second part is about the sample before.
        first = condition.args[0]
        return from_truth(first) if isinstance(first, Condition) else None
    return from_truth(condition) if register.kind in ("time_since", "total_time", "total_time_since") else None


def counted_since(register: Register) -> Formula | None:
    """Return q of a register of ``times_since(p, q)``, ``value_at(x, q)`` or their like; None for others."""
    update = register.update.args[0] if isinstance(register.update, Op) else register.update
    if not isinstance(update, When):
        return None
    if register.kind in ("highest_since", "lowest_since", "value_at"):
        update = update.otherwise
        return from_truth(update.cases[0][0]) if isinstance(update, When) else None
    return from_truth(update.cases[1][0]) if register.kind in ("times_since", "total_time_since") else None


def remembered(name: str, registers: Mapping[str, Register]) -> Formula | None:
    """Return the formula whose robustness a register keeps for the next sample; None for other registers."""
    register = registers.get(name)
    return from_robustness(register.update) if register is not None and register.kind == "last" else None


def goal_in_time(register: Register, registers: Mapping[str, Register], timers: Collection[str]) -> Formula | None:
    """Return b of a register that counts from ``b & recent(5 s, a)``, a goal of a chain that came in time; else None.

    ``timers`` are the names of the atoms that are timers.
    """
    operand = counted(register, registers)
    if operand is None or operand.op != "and":
        return None
    goal = [part for part in operand.args if (part.args[0] if part.op == "not" else part).name not in timers]
    is_timed = any(name in timers for part in goal for name in part.atoms())
    return None if is_timed or len(goal) in (0, len(operand.args)) else and_(*goal)


def past_operands(register: Register) -> tuple[Formula, ...] | None:
    """Return p of a register of ``once p`` or ``historically p``, p and q of ``p since q``; None for others."""
    if register.kind not in ("once", "historically", "since") or not isinstance(register.update, Op):
        return None
    parts = register.update.args
    operands = parts if register.kind != "since" or not isinstance(parts[1], Op) else (parts[1].args[0], parts[0])
    formulas = [from_robustness(part) for part in operands if not isinstance(part, Before)]
    known = tuple(formula for formula in formulas if formula is not None)
    return known if len(known) == len(formulas) else None


def waited_for(register: Register) -> Answer | None:
    """Return what a register of the kind ``waiting`` or ``due`` waits for; None for other registers."""
    update = register.update
    if register.kind == "waiting":
        update = update.args[0] if isinstance(update, Op) else update
        if not isinstance(update, When):
            return None
        strict = len(update.cases) == 2
        request = from_truth(update.cases[-1][0])
        # In seconds, the first case is that of a request that waits for ever.
        met: Expression | Condition = update.cases[len(update.cases) == 4][0]
        for position in (1, 0) if strict else ():
            # The oldest request goes on waiting: some request waits, and `not goal`.
            met = met.args[position] if isinstance(met, Condition) else met
        goal = from_truth(met) if isinstance(met, Condition) else None
    elif register.kind == "due" and isinstance(update, Op):
        strict = update.op == "max"
        left, right = update.args
        missed, request_value = (left.args[0], right) if strict else (left, right.args[0])  # type: ignore[union-attr]
        request, missed_goal = from_robustness(request_value), from_robustness(missed)
        goal = None if missed_goal is None else opposite(missed_goal)
    else:
        return None
    return None if request is None or goal is None else Answer(request, goal, strict)


def broken_rule(register: Register, registers: Mapping[str, Register]) -> tuple[Formula, Formula] | None:
    """Return the event and the rule of a register that a rule after an event is broken; None for other registers.

    The event is true if the rule applies from the first sample on.
    """
    timer = _timer_of_breach(register, registers)
    if timer is None:
        return None
    event = TRUE if timer.kind in ("samples", "elapsed") else counted(timer, registers)
    formula = from_robustness(cast("Op", register.update).args[1])
    return None if event is None or formula is None else (event, opposite(formula))


def _timer_of_breach(register: Register, registers: Mapping[str, Register]) -> Register | None:
    """Return the register with the time since the event, after which a rule applies; None for other registers."""
    if register.kind != "breach" or not isinstance(register.update, Op) or len(register.update.args) != 2:
        return None
    read = [node.name for node in nodes(register.update.args[0]) if isinstance(node, SignalValue)]
    return registers.get(read[0]) if len(read) == 1 else None


def kept_rules(fspa: Fspa) -> dict[str, Formula]:
    """Map the name of each atom that says that a rule about this sample is broken to the rule."""
    names = {item.name for item in fspa.atoms}
    rules = {name: _kept_rule(value) for name, value in breaches_now(fspa).items() if name in names}
    return {name: rule for name, rule in rules.items() if rule is not None}


def rules_of_every_sample(fspa: Fspa) -> dict[str, Formula]:
    """Map the name of each timer after the event ``true``, which is at every sample, to the rule that the timer breaks.

    The time since this event is always 0: ``breach(2 s, true, a)`` breaks the rule ``a``, ``lately(2 s, true)`` always
    holds, and so breaks the rule ``false``, and ``passed(2 s, true)`` never holds.
    """
    registers = {register.name: register for register in fspa.registers}
    rules: dict[str, Formula] = {}
    for item in fspa.atoms:
        read = names_read(item)
        register = registers.get(next(iter(read))) if len(read) == 1 and item.timer is not None else None
        if register is None:
            continue
        if item.base == "breach":
            timer = _timer_of_breach(register, registers)
            if timer is None or timer.kind != "time_since" or counted(timer, registers) is not TRUE:
                continue
            rule = _kept_rule(cast("Op", register.update).args[1])
            if rule is not None:
                rules[item.name] = rule
        elif (
            item.base in ("lately", "passed") and register.kind == "time_since" and counted(register, registers) is TRUE
        ):
            rules[item.name] = FALSE if evaluate(item.expression, {register.name: 0.0}, {}) > 0.0 else TRUE
    return rules


def with_rules(formula: Formula, rules: Mapping[str, Formula]) -> Formula:
    """Return a formula with the rules themselves in place of the atoms that say that they are broken.

    ``rules`` maps the names of these atoms to the rules.
    """
    done: dict[Formula, Formula] = {}
    for node in formula.bottom_up():
        operand = node.args[0] if node.op == "not" else node
        if operand.op == "atom" and operand.name in rules:
            rule = rules[operand.name]
            done[node] = rule if node is not operand else negation_normal_form(not_(rule))
        else:
            changed = rebuild(node, tuple(done[argument] for argument in node.args))
            done[node] = changed if changed is node else _folded(changed)
    return done[formula]


def listed(formula: Formula, is_rule: Callable[[Formula], bool]) -> Formula:
    """Return a formula with ``G !late & G !breach`` in place of ``G(!late & !breach)``, where a part is a rule."""
    done: dict[Formula, Formula] = {}
    for node in formula.bottom_up():
        changed = rebuild(node, tuple(done[operand] for operand in node.args))
        if changed.op == "G" and changed.args[0].op == "and" and any(map(is_rule, changed.args[0].args)):
            changed = and_(*map(always, changed.args[0].args))
        done[node] = changed
    return done[formula]


def _folded(node: Formula) -> Formula:
    """Return an equivalent formula without the constants that rules put in the place of timers.

    ``F F a`` and ``F X F a``, which they leave, become ``F a`` and ``X F a``; ``G !F a`` becomes ``!F a``.
    """
    if node.op in ("and", "or"):
        return drop_constants(node)
    if node.op == "U" and node.args[0] is TRUE:
        return eventually(node.args[1])
    if node.op == "R" and node.args[0] is FALSE:
        return always(node.args[1])
    if node.op == "F":
        return node.args[0] if _is_about_later(node.args[0]) else node
    if node.op == "G" and node.args[0].op == "not":
        return node.args[0] if _is_about_later(node.args[0].args[0]) else node
    return node


def _is_about_later(formula: Formula) -> bool:
    """Whether the formula is ``F a`` or ``X F a``, so that it holds wherever it holds at a later step."""
    return (formula.args[0] if formula.op == "X" else formula).op == "F"


def _kept_rule(value: Expression) -> Formula | None:
    """Return the rule that is broken where a formula has this robustness; None for other expressions.

    ``!a | b`` becomes ``a -> b``: the two have the same robustness.
    """
    if not isinstance(value, Op) or value.op not in ("min", "max"):
        literal = from_robustness(value)
        return None if literal is None else opposite(literal)
    parts = [part for argument in value.args if (part := _kept_rule(argument)) is not None]
    if len(parts) < len(value.args):
        return None
    if value.op == "max":
        return and_(*parts)
    first = next((index for index, argument in enumerate(value.args) if _begins_negated(argument)), len(parts))
    given = not_(and_(*(negation_normal_form(not_(part)) for part in parts[:first])))
    if first in (0, len(parts)):
        return given if first else or_(*parts)
    return implies(given.args[0], or_(*parts[first:]))


def _begins_negated(value: Expression) -> bool:
    while isinstance(value, Op) and value.op in ("min", "max"):
        value = value.args[0]
    return isinstance(value, When)


def opposite(formula: Formula) -> Formula:
    """Return the negation of a formula, without a double one."""
    return formula.args[0] if formula.op == "not" else not_(formula)


class Window(NamedTuple):
    """A comparison of a time with its ``border``: at most this long ago if ``is_recent``, else at least."""

    border: float
    is_recent: bool


def window_of(expression: Expression) -> Window | None:
    """Return the window of which an expression is the robustness; None for other expressions."""
    if isinstance(expression, When):
        # The margin of a window in seconds is negated, so that its border belongs to it.
        (margin, _) = expression.cases[0][0].args
        window = window_of(cast("Expression", margin))
        return None if window is None else window._replace(is_recent=not window.is_recent)
    if not isinstance(expression, Op) or expression.op != "/":
        return None
    margin, border = expression.args
    if not isinstance(border, Const) or not isinstance(margin, Op) or margin.op != "-":
        return None
    return Window(border.value, isinstance(margin.args[0], Const))


# --- from expressions -----------------------------------------------------------------------------


def from_truth(condition: Condition) -> Formula | None:
    """Return the formula of which ``registers.truth`` is a condition; None for other conditions."""
    if condition.op == ">":
        value = condition.args[0]
        if isinstance(value, Const):
            return TRUE if value.value > 0 else FALSE
        return atom(value.name) if isinstance(value, AtomValue) else None
    parts = [from_truth(part) if isinstance(part, Condition) else None for part in condition.args]
    return _joined(condition.op, parts)


def from_robustness(value: Expression) -> Formula | None:
    """Return the formula of which ``registers.robustness`` is an expression; None for other expressions."""
    if isinstance(value, Const):
        return TRUE if value.value > 0 else FALSE
    if isinstance(value, AtomValue):
        return atom(value.name)
    if isinstance(value, When):
        # The opposite of a value, which is above 0 where the value is 0.
        tested = value.cases[0][0].args[0]
        return _joined("not", [from_robustness(tested) if not isinstance(tested, Condition) else None])
    if isinstance(value, Op) and value.op in ("min", "max"):
        return _joined("and" if value.op == "min" else "or", [from_robustness(part) for part in value.args])
    return None


def _joined(op: str, parts: list[Formula | None]) -> Formula | None:
    """Return ``not``, ``and`` or ``or`` of formulas, with ``implies`` and ``iff`` where these are meant."""
    known = [part for part in parts if part is not None]
    if len(known) < len(parts) or op not in ("not", "and", "or"):
        return None
    if op == "not":
        return not_(known[0])
    if op == "or" and len(known) == 2:
        left, right = known
        neither = (and_(*map(opposite, left.args)), not_(or_(*left.args))) if len(left.args) == 2 else ()
        if left.op == "and" and right in neither:
            return iff(*left.args)
        if left.op == "not":
            return implies(left.args[0], right)
    return and_(*known) if op == "and" else or_(*known)
