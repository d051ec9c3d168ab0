"""Say in words what the atoms of long chains of goals say: "a, then b within 5 s after a"."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.value_phrases import Phrase
from tltlc.logic.formula import Formula, always, and_, atom, eventually, next_, not_
from tltlc.resolve.spec import Atom


class GoalPhrase(NamedTuple):
    """A goal of a chain in words: "b within 5 s after a".

    If not ``later``, it may come at the sample of the goal before it.
    """

    words: str
    later: bool = True


def chains(fspa: Fspa) -> dict[str, list[GoalPhrase]]:
    """Return the goals of each atom about a chain."""
    goals_of: dict[str, list[GoalPhrase]] = {}
    for item in fspa.atoms:
        if item.timer is not None and item.base in ("chain", "lost"):
            goals, times = item.arguments[::2], item.arguments[1::2]
            goals_of[item.name] = [GoalPhrase(goals[0])]
            for (last, goal), time, later in zip(pairwise(goals), times, item.timer.later, strict=True):
                words = f"{goal} {'within ' if later else ''}{time} after {last}"
                goals_of[item.name].append(GoalPhrase(words, later))
    return goals_of


def chain_phrase(item: Atom) -> Phrase:
    """Return the phrase of an atom about a chain."""
    chain = f"the chain from {item.arguments[0]} to {item.arguments[-1]}"
    return Phrase(chain if item.base == "chain" else f"the end of {chain}")


def in_order(
    node: Formula, known: Mapping[str, Sequence[GoalPhrase]], done: Mapping[Formula, Formula]
) -> Formula | None:
    """Return ``F chain(a, 5 s, b)`` as ``F(a & X F b)``, where b is "b within 5 s after a"; None for other formulas.

    ``!lost U chain`` becomes the same: the last goal must come before the chain is lost. ``!F chain`` is to
    avoid one event, "a, then b within 5 s after a". ``known`` has the goals in words (:func:`chains`), and
    ``done`` the phrases of the operands.
    """
    outer = node.args[0] if node.op == "not" else node
    if outer.op not in ("F", "U"):
        return None
    parts = outer.args[-1].args if outer.args[-1].op == "and" else (outer.args[-1],)
    chain = next((part for part in parts if part.op == "atom" and part.name in known), None)
    if chain is None:
        return None
    first, *others = known[chain.name]
    if node is not outer and len(parts) == 1:
        links = (f", then {'' if goal.later else 'or at the same time '}{goal.words}" for goal in others)
        return always(not_(atom("".join((first.words, *links)))))
    goals = [first, *others]
    result = and_(atom(goals[-1].words), *(done[part] for part in parts if part is not chain))
    for goal, following in reversed([*pairwise(goals)]):
        rest = eventually(result)
        result = and_(atom(goal.words), next_(rest) if following.later else rest)
    return eventually(result) if node is outer else not_(eventually(result))
