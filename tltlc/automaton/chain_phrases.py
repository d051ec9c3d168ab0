"""Say in words what the atoms of long chains of goals say: "a, then b within 5 s after a"."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.value_phrases import Phrase
from tltlc.expression.tree import SignalValue, nodes
from tltlc.logic.formula import Formula, always, and_, atom, eventually, next_, not_
from tltlc.resolve.spec import Atom


def chains(fspa: Fspa) -> dict[str, list[str]]:
    """Return the goals of each atom about a chain in words: ``a`` and ``b within 5 s after a``."""
    kinds = {register.name: register.kind for register in fspa.registers}
    goals_of: dict[str, list[str]] = {}
    for item in fspa.atoms:
        read = {node.name for node in nodes(item.expression) if isinstance(node, SignalValue)}
        kept = sum(kinds.get(name) == "last" for name in read)
        # An atom of a predicate with one of these names would not read what is kept of each goal.
        if item.base in ("chain", "lost") and 2 * kept - len(item.arguments) in (1, -1):
            goals, times = item.arguments[::2], item.arguments[1::2]
            timed = zip(pairwise(goals), times, strict=True)
            goals_of[item.name] = [goals[0], *(f"{goal} within {time} after {last}" for (last, goal), time in timed)]
    return goals_of


def chain_phrase(item: Atom) -> Phrase:
    """Return the phrase of an atom about a chain."""
    chain = f"the chain from {item.arguments[0]} to {item.arguments[-1]}"
    return Phrase(chain if item.base == "chain" else f"the end of {chain}")


def in_order(node: Formula, known: Mapping[str, Sequence[str]], done: Mapping[Formula, Formula]) -> Formula | None:
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
    if node is not outer and len(parts) == 1:
        return always(not_(atom(", then ".join(known[chain.name]))))
    *goals, last = map(atom, known[chain.name])
    result = eventually(and_(last, *(done[part] for part in parts if part is not chain)))
    for goal in reversed(goals):
        result = eventually(and_(goal, next_(result)))
    return result if node is outer else not_(result)
