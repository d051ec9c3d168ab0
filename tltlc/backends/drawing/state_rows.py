"""The rows of text in a state of a picture: its label, and the timers that run in it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from tltlc.automaton.fspa import Fspa, Notation, State, Text
from tltlc.automaton.memory_phrases import Speaker
from tltlc.automaton.text import label_range_text, label_text
from tltlc.backends.drawing.timers import Timer
from tltlc.expression.tree import SignalValue
from tltlc.logic.formula import TRUE, Formula, always, and_, atom, next_, not_
from tltlc.logic.text.english import clause_text
from tltlc.logic.text.phrases import is_state, phrase
from tltlc.logic.text.printer import english_text

MOST_RULES: Final = 8
"""The most rules of a state that have a row each; a further row counts the rest."""


def state_rows(fspa: Fspa, run: Sequence[State], timers: Mapping[str, Timer], notation: Notation) -> tuple[str, ...]:
    """Return the rows of a drawn state: its label, in the notation, and its timers.

    ``run`` has the state, or all states that are folded into it. ``timers`` has the timers that run in
    it, by the names of their atoms. The label of an automaton with registers is in words. Each of its
    rules has a row, where a timer stands for the rule that it measures.
    """
    first, last = run[0], run[-1]
    if not fspa.registers:
        return (label_range_text(fspa, first.id, last.id, notation),)
    label = first.label
    if first is not last or isinstance(label, Text) or label.op in ("true", "false"):
        return (label_range_text(fspa, first.id, last.id, "english"), *_distinct(timers.values()))
    return _rows(fspa, label, timers)


def _distinct(timers: Iterable[Timer]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(map(str, timers)))


def full_label(fspa: Fspa, run: Sequence[State], notation: Notation) -> str:
    """Return the label of a drawn state as one text, for its tooltip."""
    if not fspa.registers:
        return label_range_text(fspa, run[0].id, run[-1].id, notation)
    return label_text(fspa, run[0].id)


def _rows(fspa: Fspa, label: Formula, timers: Mapping[str, Timer]) -> tuple[str, ...]:
    endless, speaker = fspa.semantics == "infinite", Speaker(fspa)
    parts = label.args if label.op == "and" else (label,)
    goals = [part for part in parts if part.op != "G"]
    rules = [rule for part in parts if part.op == "G" for rule in _conjuncts(part.args[0])]
    due = _due_atoms(fspa)
    rules = [rule for rule in rules if not (_asks_for_next(rule) and rule.args[0].name in due)]
    rules.sort(key=_asks_for_next)
    rows = [english_text(speaker.spoken(and_(*goals)), endless=endless)] if goals else []
    measured = {not_(atom(name)): timer for name, timer in timers.items()}
    texts = [str(measured[rule]) if rule in measured else _rule(speaker.spoken(rule), endless) for rule in rules]
    others = _distinct(timer for rule, timer in measured.items() if rule not in rules)
    if len(texts) == 1:
        return (*rows, texts[0] if rules[0] in measured else f"Always: {texts[0]}", *others)
    if texts:
        rest = len(texts) - MOST_RULES
        rows += ["Always:", *texts[:MOST_RULES], *([f"and {rest} more rules"] if rest > 0 else [])]
    return (*rows, *others)


def _conjuncts(formula: Formula) -> tuple[Formula, ...]:
    return formula.args if formula.op == "and" else (formula,)


def _rule(rule: Formula, endless: bool) -> str:
    if is_state(rule):
        return phrase(rule)
    if _asks_for_next(rule):
        return f"the trace goes on after {phrase(rule.args[0])}"
    return clause_text(always(rule), endless=endless)


def _asks_for_next(rule: Formula) -> bool:
    """Whether a rule asks for a sample after each sample at which something holds: ``p -> X true``."""
    return rule.op == "implies" and rule.args[1] is next_(TRUE)


def _due_atoms(fspa: Fspa) -> frozenset[str]:
    """Return the atoms that say that a goal is due.

    A response has two rules: its goal is not late, and the trace goes on while its goal is due. The
    words of the first imply the second.
    """
    due = {register.name for register in fspa.registers if register.kind == "due"}
    return frozenset(
        atom.name for atom in fspa.atoms if isinstance(atom.expression, SignalValue) and atom.expression.name in due
    )
