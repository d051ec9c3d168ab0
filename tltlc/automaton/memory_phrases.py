"""Say in words what atoms remember: ``times(seen) > 3`` is "seen more than 3 times".

The words are chosen by the kind of the register that an atom reads, not by the name of the atom. An
atom without words of its own, such as that of a sum of counts, keeps its name.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Final

from tltlc.automaton.chain_phrases import chain_phrase, chains, in_order
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.remembered_formulas import (
    Answer,
    broken_rule,
    counted,
    counted_since,
    goal_in_time,
    kept_rules,
    listed,
    names_read,
    opposite,
    past_operands,
    remembered,
    rules_of_every_sample,
    waited_for,
    window_of,
    with_rules,
)
from tltlc.automaton.timer_phrases import ALWAYS, FROM_START, TIMERS
from tltlc.automaton.value_phrases import (
    VALUES,
    Phrase,
    count_text,
    is_of_window,
    time_text,
    value_phrase,
    was_phrase,
    window_text,
)
from tltlc.core.names import ComparisonName, SpokenName, full_name, split_name, with_calls
from tltlc.core.record import record
from tltlc.expression.tree import Before, SignalValue
from tltlc.logic.formula import TRUE, Formula, always, and_, atom, eventually, implies, not_, or_, rebuild
from tltlc.logic.implication import complement
from tltlc.logic.normal_form import negation_normal_form
from tltlc.logic.text.phrases import bracketed_phrase, is_state, phrase
from tltlc.resolve.registers import COUNTS
from tltlc.resolve.spec import Atom, Register

_UNTIL: Final = ("passed", "lasted", "over", "recent", "lately")
"""The bases of the names of timers that say until when something must happen, or how long it must last."""
_CONDITIONS: Final = {
    "times": 1,
    "times_within": 1,
    "times_since": 2,
    "time_since": 1,
    "time_holding": 1,
    "total_time": 1,
    "total_time_since": 2,
    "highest_since": 1,
    "lowest_since": 1,
    "value_at": 1,
}
"""How many arguments of a function of the past are conditions, by the kind of its register."""
_OPPOSITE_FACTS: Final = {
    "once": "{0} all along",
    "historically": "{0} now or before",
    "since": "{0} since {1} or no {1} so far",
    "previously": "{0} at the step before",
}
"""What holds where ``once p``, ``historically p``, ``p since q`` or ``previously p`` does not.

0 stands for the opposite of p, and 1 for q. ``previously p`` does not hold at the first step, either.
"""
_COUNTING: Final = frozenset({"samples", "elapsed", "time_since", "age"})
"""The kinds of the registers that these timers read."""


@record
class Turn:
    """What begins or ends: the ``subject`` in words, and the ``verb``, "begin" or "end"."""

    subject: str
    verb: str

    @property
    def text(self) -> str:
        """The turn in words: ``seen begins``."""
        return f"{self.subject} {self.verb}s"


def _single(formula: Formula) -> Formula:
    """Return a formula without a double negation before it."""
    while formula.op == "not" and formula.args[0].op == "not":
        (formula,) = formula.args[0].args
    return formula


def spoken(formula: Formula, fspa: Fspa) -> Formula:
    """Return the formula for people, with phrases in place of the names of atoms.

    No automaton has atoms with such names, so the result is only good for printing.
    """
    return Speaker(fspa).spoken(formula) if fspa.registers else formula


class Speaker:
    """Says the formulas of one automaton in words."""

    def __init__(self, fspa: Fspa) -> None:
        self._clock_s = fspa.clock_s
        self._registers = {register.name: register for register in fspa.registers}
        self._atoms = {item.name: item for item in fspa.atoms}
        self._before = {name: operand for name in self._atoms if (operand := self._previous_operand(name)) is not None}
        self.timers = frozenset(name for name, item in self._atoms.items() if item.timer is not None and item.arguments)
        nodes = fspa.formula.walk() if isinstance(fspa.formula, Formula) else ()
        waits = (node.args[0] for node in nodes if node.op == "U")
        self._waits = {(wait.args[0] if wait.op == "not" else wait).name for wait in waits}
        self._phrases: dict[str, Phrase | None] = {}
        self._rules = {**kept_rules(fspa), **rules_of_every_sample(fspa)}
        self._chains = chains(fspa)
        self._passed = self._passed_times()

    def spoken(self, formula: Formula) -> Formula:
        """Return a formula with phrases in place of the names of atoms."""
        done: dict[Formula, Formula] = {}
        for node in listed(with_rules(formula, self._rules), self._is_rule).bottom_up():
            done[node] = (
                in_order(node, self._chains, done)
                or self._answers(node, done)
                or self._turning(node, done)
                or self._rule(node)
                or self._in_time(node, done)
                or self._literal(node)
                or rebuild(node, tuple(done[operand] for operand in node.args))
            )
        return done[node]

    def is_about_past(self, name: str) -> bool:
        """Whether an atom is a condition on the steps so far, such as "seen since alarm", and no comparison."""
        return not isinstance(self._atoms[name].base, ComparisonName) and self._phrase(name) is not None

    def is_earlier(self, name: str) -> bool:
        """Whether an atom says that something has held at an earlier step: ``previously once p``."""
        return name in self._before and self._occurred(self._before[name]) is not None

    def fact(self, name: str, *, holds: bool, is_first: bool) -> str | None:
        """Return what an atom about the past says where it holds, or where not; None if it has no opposite in words.

        ``!seen since alarm`` fails where "seen since alarm or no alarm so far" holds. ``is_first`` says whether
        it is the first step.
        """
        words = self._phrase(name)
        if words is None:
            return None
        if words.fails is not None:
            return words.holds if holds else words.fails
        denied = self._opposite_fact(self._atoms[name], is_first=is_first)
        return words.holds if holds and denied is not None else denied

    def _opposite_fact(self, item: Atom, *, is_first: bool) -> str | None:
        """Return what holds where an atom about the past does not; None unless it is about a negation or comparison."""
        register = self._register_of(item)
        formulas = past_operands(register)
        if item.name in self._before and not is_first:
            formulas = (self._before[item.name],)
        if formulas is None or not (formulas[0].op == "not" or self._is_comparison(formulas[0])):
            return None
        words = [self.object_text(formula) for formula in (opposite(formulas[0]), *formulas[1:])]
        return _OPPOSITE_FACTS[register.kind].format(*words)

    def _is_comparison(self, state: Formula) -> bool:
        return state.op == "atom" and isinstance(self._atoms[state.name].base, ComparisonName)

    # --- formulas ---------------------------------------------------------------------------------

    def _is_rule(self, part: Formula) -> bool:
        """Whether a part of ``G(part & …)`` says that no answer is late, or that no rule is broken."""
        return self._ruled_out(always(part), "late") is not None or self._ruled_out(always(part), "breach") is not None

    def _literal(self, node: Formula) -> Formula | None:
        negated = node.op == "not" and node.args[0].op == "atom"
        words = self._phrase((node.args[0] if negated else node).name) if negated or node.op == "atom" else None
        if words is None:
            return None
        if negated:
            return None if words.fails is None else atom(words.fails)
        return atom(words.holds)

    def _turning(self, node: Formula, done: Mapping[Formula, Formula]) -> Formula | None:
        """Return ``seen & !previously seen & x`` as "seen begins" and x, and the reverse as "seen ends"; else None.

        ``!seen | previously seen | F x`` is its negation or ``F x``.
        """
        turn = self._turn(node.args[0]) if node.op == "not" else None
        if turn is not None:
            return atom(f"{turn[0]} does not {turn[1]}")
        # In a label, "whenever seen begins, x" is `!seen | previously seen | x`.
        is_denied = node.op == "or" and not all(map(is_state, node.args))
        if node.op != "and" and not is_denied:
            return None
        original = {_single(part): part for part in node.args}
        turns, parts = self.turns((*original,), is_denied=is_denied)
        if not turns:
            return None
        edges = [not_(atom(turn.text)) if is_denied else atom(turn.text) for turn in turns]
        rest = [done[original[part]] for part in parts]
        return edges[0] if len(edges) + len(rest) == 1 else rebuild(node, (*edges, *rest))

    def turns(self, literals: Sequence[Formula], *, is_denied: bool = False) -> tuple[list[Turn], list[Formula]]:
        """Return what begins or ends by these literals, and the literals that are left.

        If ``is_denied``, the literals are the opposites of those by which it does.
        """
        turns, rest = [], list(literals)
        for operand, verb, members in self._edges:
            needed = tuple(map(opposite, members)) if is_denied else members
            if all(part in rest for part in needed):
                rest = [part for part in rest if part not in needed]
                turns.append(Turn(self._subject_text(operand), verb))
        return turns, rest

    def _answers(self, node: Formula, done: Mapping[Formula, Formula]) -> Formula | None:
        """Return ``G !late & G(due -> X true)`` as "whenever alarm, reach hidden within 5 s", else None.

        Other parts of the conjunction are kept.
        """
        if node.op != "and":
            return None
        late = {part: item for part in node.args if (item := self._ruled_out(part, "late")) is not None}
        due = {part: item for part in node.args if (item := self._going_on(part)) is not None}
        answers: dict[Formula, Formula] = {}
        for part, item in late.items():
            answer = self._answer(item)
            ends = [other for other, owed in due.items() if answer is not None and self._answer(owed) == answer]
            if answer is None or not ends:
                continue
            answered = atom(SpokenName(f"{self.noun_text(answer.goal)} within {item.arguments[0]}", "reach"))
            request = self.spoken(answer.request)
            answers[part] = always(answered if request is TRUE else implies(request, answered))
            answers.update(dict.fromkeys(ends, TRUE))
        if not answers:
            return None
        parts = [answers.get(part) or done[part] for part in node.args]
        return and_(*(part for part in parts if part is not TRUE))

    def _rule(self, node: Formula) -> Formula | None:
        """Return ``G !breach`` as "whenever alarm, avoid seen for 5 s", else None."""
        item = self._ruled_out(node, "breach")
        broken = None if item is None else broken_rule(self._register_of(item), self._registers)
        if item is None or broken is None or broken[0] is TRUE or self._is_timed(broken[0]):
            return None
        event, rule = broken
        return always(implies(self.spoken(event), self._lasting(rule, f"for {item.arguments[0]}")))

    def _lasting(self, rule: Formula, time: str) -> Formula:
        """Return "keep hidden for 5 s", or "avoid seen for 5 s"."""
        if rule.op == "not":
            return not_(atom(SpokenName(f"{self.noun_text(rule.args[0])} {time}")))
        return atom(SpokenName(f"{self.noun_text(rule)} {time}", "keep"))

    def _in_time(self, node: Formula, done: Mapping[Formula, Formula]) -> Formula | None:
        """Return ``!passed(5 s, a) U b`` as ``F`` of "b within 5 s after a", and ``lasted(5 s) R b`` as one atom.

        On a clock that varies, these are ``recent(5 s, a) U (recent(5 s, a) & b)`` and
        ``lasted(5 s) R (lasted(5 s) | b)``. A negation of the one is the other, of ``!b``, and so is a condition, as
        in ``(!passed(5 s) U a) -> b``. Return None for any other formula.
        """
        if node.op == "implies" and node.args[0].op in ("U", "R"):
            given = self._in_time(not_(node.args[0]), done)
            return None if given is None else or_(given, done[node.args[1]])
        if node.op == "not" and node.args[0].op in ("U", "R"):
            node = complement(node.args[0], depth=2)
            if not all(map(is_state, node.args)):
                return None
        if node.op not in ("U", "R"):
            return None
        timer, goal = node.args
        if node.op == "U":
            passed = (timer.args[0] if timer.op == "not" else timer).name
            if passed not in self._passed:
                return None
            parts = tuple(part for part in (goal.args if goal.op == "and" else (goal,)) if part is not timer)
            present = [part for part in parts if is_state(part)]
            if not present:
                return None
            state = and_(*present)
            in_words = self.spoken(state)
            words = self.noun_text(state) if in_words.op == "atom" else bracketed_phrase(in_words)
            text = f"{words} within {self._passed[passed]}"
            return eventually(and_(atom(text), *(done[part] for part in parts if part not in present)))
        kept = or_(*(part for part in (goal.args if goal.op == "or" else (goal,)) if part is not timer))
        passed = (timer.args[0] if timer.op == "not" else timer).name
        if passed not in self._passed or not is_state(kept):
            return None
        return self._lasting(kept, f"for {self._passed[passed]}")

    def _ruled_out(self, node: Formula, base: str) -> Atom | None:
        """Return the timer with this base that ``G !timer`` rules out, else None."""
        is_rule = node.op == "G" and node.args[0].op == "not"
        item = self._atoms.get(node.args[0].args[0].name) if is_rule else None
        return item if item is not None and item.base == base else None

    def _going_on(self, node: Formula) -> Atom | None:
        """Return the answer that is due in ``G(due -> X true)``, else None."""
        if node.op != "G" or node.args[0].op != "implies":
            return None
        item, end = self._atoms.get(node.args[0].args[0].name), node.args[0].args[1]
        return item if item is not None and item.base == "due" and (end.op, *end.args) == ("X", TRUE) else None

    # --- atoms ------------------------------------------------------------------------------------

    def _phrase(self, name: str) -> Phrase | None:
        """Return the phrase of an atom; None if it has none."""
        if name in self._chains:
            return chain_phrase(self._atoms[name])
        if name not in self._phrases:
            item = self._atoms.get(name)
            read = [] if item is None else self._read(item)
            words = self._phrase_of(item, read[0]) if item is not None and len(read) == 1 else None
            self._phrases[name] = words if words is not None or item is None else self._comparison(item)
        return self._phrases[name]

    def _comparison(self, item: Atom) -> Phrase | None:
        """Return a comparison of sums, or of two values, with the conditions in it in words; None for other atoms."""
        name = item.base
        if item.timer is not None or not isinstance(name, ComparisonName):
            return None
        left, right = self.quantity_text(name.left), self.quantity_text(name.right)
        if (left, right) == (name.left, name.right):
            return None
        comparison = ComparisonName(left, name.operator, right)
        return Phrase(comparison, comparison.opposite)

    def quantity_text(self, text: str) -> str:
        """Return a side of a comparison with the conditions in it in words: ``times(not a)`` for ``times(!a)``."""
        return with_calls(text, self._call_text) if self._registers else text

    def _call_text(self, call: str) -> str | None:
        """Return a call of a function of the past in words; None for calls that are not about a condition."""
        base, arguments = split_name(call)
        # A maximum is left out of the name of the register.
        register = self._registers.get(call) or self._registers.get(full_name(base, arguments[:-1]))
        if register is None or register.kind not in _CONDITIONS:
            return None
        # `value_at(x, q)` and its like have a value before their condition.
        first = int(register.kind in VALUES)
        formulas = (counted(register, self._registers), counted_since(register))
        words = [self._argument_text(formula) for formula in formulas if formula is not None]
        if len(words) != _CONDITIONS[register.kind]:
            return None
        return full_name(base, (*arguments[:first], *words, *arguments[first + len(words) :]))

    def _argument_text(self, state: Formula) -> str:
        """Return a formula as an argument of a function: "begins damage" where it begins to hold."""
        turn = self._turn(state)
        return phrase(self.spoken(state)) if turn is None else f"{turn[1]}s {turn[0]}"

    def _phrase_of(self, item: Atom, register: Register) -> Phrase | None:
        """Return the phrase of an atom that reads one register; None if it has none."""
        if register.kind == "breach" and len(item.arguments) == 1:
            return None
        timer = TIMERS.get(register.kind, {}).get(item.base)
        if item.timer is not None and timer is not None:
            return self._timer_phrase(item, register, timer)
        if register.kind == "last":
            operand = remembered(register.name, self._registers) if len(names_read(item)) == 1 else None
            turn = None if operand is None else self._turn(operand)
            fails = turn and f"{turn[0]} does not {turn[1]}"
            return None if operand is None else Phrase(phrase(self.spoken(operand)), fails)
        if register.kind in VALUES:
            return value_phrase(item.base, register, self.event_text(register))
        if len(names_read(item)) > 1:
            return None
        if register.kind in ("once", "historically", "since", "previously"):
            return self._past_phrase(item, register)
        operand = counted(register, self._registers)
        if operand is None:
            return None
        if isinstance(item.base, ComparisonName):
            if item.base.left != register.name:
                return None
            words, number = self.object_text(operand), item.base.right
            since = counted_since(register)
            begin = "" if since is None else f"since {self.noun_text(since)}"
            if is_of_window(register):
                begin = window_text(register)
            when = window_text(register) if register.kind == "times_within" else begin
            holds, fails = (
                count_text(words, operator, number, when)
                if register.kind in COUNTS
                else " ".join(filter(None, (time_text(words, register, operator, number), begin)))
                for operator in (item.base.operator, item.base.opposite_operator)
            )
            verb = "be" if register.kind == "time_since" else ""
            return Phrase(*(SpokenName(text, verb, is_past=True) for text in (holds, fails)))
        window = self.window(item)
        if window is None:
            return None
        time, is_recent = window
        if is_recent:
            return Phrase(SpokenName(f"{self.object_text(operand)} in the last {time}", is_past=True))
        fails = SpokenName(f"a step with {self.object_text(opposite(opposite(operand)))} in the last {time}", "have")
        return Phrase(SpokenName(f"{self.object_text(opposite(operand))} for the last {time}", is_past=True), fails)

    def window(self, item: Atom) -> tuple[str, bool] | None:
        """Return the time of ``once within T p`` and True, or that of ``historically for T p`` and False; else None."""
        registers = self._read(item)
        # A predicate, whose name has no spaces, may compute what looks like a window.
        is_named = " " in item.base and not isinstance(item.base, ComparisonName)
        window = window_of(item.expression) if is_named and len(registers) == 1 else None
        if window is None or registers[0].kind != "time_since":
            return None
        # `once within n steps` has its border at n + 1/2 steps, `historically for n steps` at n - 1/2.
        border, is_recent = window
        steps = border - 0.5 if is_recent else border + 0.5
        time = f"{steps:g} steps" if self._clock_s is None else f"{round(steps * self._clock_s, 6):g} s"
        return f"{border:g} s" if registers[0].unit == "s" else time, is_recent

    def _timer_phrase(self, item: Atom, register: Register, texts: tuple[str, str]) -> Phrase:
        arguments = self.arguments(item, register)
        if register.kind == "breach":
            broken = broken_rule(register, self._registers)
            texts = FROM_START if len(arguments) == 2 else texts
            if broken is None or any(map(self._is_timed, broken)):
                arguments = (*arguments, f"not {arguments[-1]}")
            else:
                arguments = (*arguments, self.object_text(opposite(broken[1])))
        elif register.kind in ("waiting", "due") and len(arguments) < 2 + (item.base == "late"):
            texts = ALWAYS[item.base]
        elif counted(register, self._registers) is TRUE:
            texts = (texts[0], texts[1].replace("no {1}", "no step"))
        return Phrase(*(text.format(*arguments) for text in texts))

    def arguments(self, item: Atom, register: Register) -> Sequence[str]:
        """Return the arguments of a timer in words."""
        formulas: tuple[Formula, ...] | None = None
        if register.kind in ("waiting", "due"):
            answer = waited_for(register)
            if answer is not None:
                formulas = (answer.goal,) if answer.request is TRUE else (answer.request, answer.goal)
        elif (broken := broken_rule(register, self._registers)) is not None:
            event, rule = broken
            if rule.op == "not" and self._turn(rule.args[0]) is None:
                rule = negation_normal_form(rule)
            formulas = (rule,) if event is TRUE and len(item.arguments) == 2 else (event, rule)
        elif item.name in self._waits and (goal := self._goal_in_time(register)) is not None:
            return (*item.arguments[:-1], f"{self.object_text(goal)} in time")
        elif (operand := counted(register, self._registers)) is not None:
            formulas = (operand,)
        first = item.base != "due"
        written = item.arguments[first:]
        if formulas is None or len(formulas) != len(written) or any(map(self._is_timed, formulas)):
            return item.arguments
        words = [self.object_text(formula) for formula in formulas]
        if item.base == "due" and waited_for(register).strict:  # type: ignore[union-attr]
            words[-1] = f"next {words[-1]}"
        return (*item.arguments[:first], *words)

    def _past_phrase(self, item: Atom, register: Register) -> Phrase | None:
        """Return the phrase of ``once p``, ``historically p``, ``p since q`` or ``previously p``."""
        if item.name in self._before:
            operand = self._before[item.name]
            if (was := was_phrase(operand, self._atoms)) is not None:
                return was
            occurred = self._occurred(operand)
            when = "at the step before" if occurred is None else "at an earlier step"
            return Phrase(SpokenName(f"{self.object_text(operand if occurred is None else occurred)} {when}"))
        formulas = past_operands(register)
        if formulas is None:
            return None
        words = [self.object_text(formula) for formula in formulas]
        form = {"once": "{0} now or before", "historically": "{0} all along", "since": "{0} since {1}"}[register.kind]
        return Phrase(SpokenName(form.format(*words)))

    def _occurred(self, state: Formula) -> Formula | None:
        """Return the formula p of an atom ``once p``; None for any other formula."""
        register = self._registers.get(state.name) if state.op == "atom" else None
        formulas = past_operands(register) if register is not None and register.kind == "once" else None
        return None if formulas is None else formulas[0]

    def object_text(self, state: Formula) -> str:
        """Return a formula without temporal operators as a phrase, in brackets unless it is short."""
        if state is TRUE:
            return "any step"
        denied = self._turn(negation_normal_form(not_(state))) if state.op in ("or", "implies") else None
        if denied is not None:
            return f"({denied[0]} does not {denied[1]})"
        in_words = self.spoken(state)
        is_long = isinstance(in_words.name, SpokenName) and " " in in_words.name
        return f"({phrase(in_words)})" if is_long else bracketed_phrase(in_words)

    def _subject_text(self, state: Formula) -> str:
        """Return a formula as what begins or ends: "(not seen) begins" is not "not (seen begins)"."""
        text = self.object_text(state)
        return f"({text})" if state.op == "not" and not text.startswith("(") else text

    def noun_text(self, state: Formula) -> str:
        """Return a formula as the object of a sentence: "the start of damage" where it begins to hold."""
        turn = self._turn(state)
        return (
            self.object_text(state) if turn is None else f"the {'start' if turn[1] == 'begin' else 'end'} of {turn[0]}"
        )

    def event_text(self, register: Register) -> str:
        """Return when a register of ``value_at(x, q)`` took its value: "alarm last held".

        For ``highest_since(x, q)`` and ``lowest_since(x, q)`` this is the event, and for other registers nothing.
        """
        event = counted_since(register) if register.kind in VALUES else None
        if event is None:
            return ""
        if register.kind != "value_at":
            return self.noun_text(event)
        turn = self._turn(event)
        if turn is not None:
            return f"{turn[0]} last {'began' if turn[1] == 'begin' else 'ended'}"
        return f"{self.object_text(event)} last held"

    def _turn(self, state: Formula) -> tuple[str, str] | None:
        """Return what begins or ends in a state, and "begin" or "end"; None for other states."""
        for operand, verb, members in self._edges if state.op == "and" else ():
            if set(state.args) == set(members):
                return self._subject_text(operand), verb
        return None

    @cached_property
    def _edges(self) -> tuple[tuple[Formula, str, tuple[Formula, ...]], ...]:
        """Each formula that is remembered, "begin" or "end", and the parts of a conjunction that say so."""
        return tuple(self._found_edges())

    def _found_edges(self) -> Iterator[tuple[Formula, str, tuple[Formula, ...]]]:
        for name, read in self._before.items():
            # `!a | b` is read back as `a -> b`.
            for operand in (read, or_(opposite(read.args[0]), read.args[1])) if read.op == "implies" else (read,):
                now = operand.args if operand.op == "and" else (operand,)
                yield operand, "begin", (*now, not_(atom(name)))
                yield operand, "end", (opposite(operand), atom(name))
                denied = negation_normal_form(not_(operand))
                yield operand, "end", (*(denied.args if denied.op == "and" else (denied,)), atom(name))

    # --- registers --------------------------------------------------------------------------------

    def _read(self, item: Atom) -> list[Register]:
        return [self._registers[name] for name in names_read(item) if name in self._registers]

    def _register_of(self, item: Atom) -> Register:
        """Return the register that a timer reads."""
        return self._read(item)[0]

    def _answer(self, item: Atom) -> Answer | None:
        return waited_for(self._register_of(item))

    def _goal_in_time(self, register: Register) -> Formula | None:
        return goal_in_time(register, self._registers, self.timers)

    def _is_timed(self, formula: Formula) -> bool:
        """Whether a formula reads a timer, as the later goals of a chain do."""
        return not self.timers.isdisjoint(formula.atoms())

    def _previous_operand(self, name: str) -> Formula | None:
        """Return the formula p of an atom ``previously p``; None for any other atom."""
        read = self._atoms[name].expression
        register = self._registers.get(read.name) if isinstance(read, SignalValue) else None
        if register is None or register.kind != "previously" or not isinstance(register.update, Before):
            return None
        return remembered(register.update.name, self._registers)

    def _passed_times(self) -> dict[str, str]:
        """Return the time of each atom that says that a time has passed, such as "5 s after a"."""
        times: dict[str, str] = {}
        for item in self._atoms.values():
            kinds = {register.kind for register in self._read(item)}
            if item.timer is not None and item.base in _UNTIL and kinds & _COUNTING:
                register = self._register_of(item)
                goal = self._goal_in_time(register) if item.name in self._waits else None
                # In a chain it goes without saying that the goal before has come in time.
                event = self.arguments(item, register)[1:] if goal is None else (self.object_text(goal),)
                times[item.name] = " after ".join((item.arguments[0], *event))
        return times
