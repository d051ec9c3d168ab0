"""The stages of a spec: what has to be done in a state of its automaton, in the words of its atoms."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Final

from tltl_runtime.stealth.expert.goals import distance_signals
from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.core.record import EMPTY
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import Expression, Param, Signal, nodes
from tltlc.monitor.tables import tables

REACHES: Final = "reaches "
"""How a deed begins that is to be somewhere."""

MEETS: Final = "meets the spec"

_FAR: Final = 1e4
"""Metres that no level has."""

_PRECISION: Final = 1e-4
"""Metres to which it is known from where on one is near."""


def target_of(fspa: Fspa, atom: int) -> str | None:
    """The entity that one must come near to, and to nothing else, for an atom to hold; None where that is not so."""
    expression = fspa.atoms[atom].expression
    names = {node.name for node in nodes(expression) if isinstance(node, Signal)}
    if len(names) != 1:
        return None
    (name,) = names
    near, far = (_holds(fspa, expression, name, metres) for metres in (0.0, _FAR))
    return distance_signals(fspa).get(name) if near and not far else None


def near_enough(fspa: Fspa, atom: int, params: Mapping[str, float]) -> float | None:
    """The metres below which an atom holds that has a target; None where it has none, or other ``params`` decide."""
    target, expression = target_of(fspa, atom), fspa.atoms[atom].expression
    if target is None or {node.name for node in nodes(expression) if isinstance(node, Param)} - params.keys():
        return None
    near, far = 0.0, _FAR
    while far - near > _PRECISION:
        middle = (near + far) / 2
        near, far = (middle, far) if _holds(fspa, expression, f"distance({target})", middle, params) else (near, middle)
    return far


def _holds(
    fspa: Fspa, expression: Expression, distance: str, metres: float, params: Mapping[str, float] = EMPTY
) -> bool:
    values = {**{param.name: param.value for param in fspa.params}, **params}
    try:
        return evaluate(expression, {distance: metres}, values) > 0.0
    except (ArithmeticError, ValueError):
        return False


def deed(fspa: Fspa, state: int) -> str:
    """What leads from a state nearer to acceptance: ``reaches `s1```, ``reaches `a` or `b```, ``makes `open` true``."""
    found = [
        words for edge in tables(fspa).improving[state] for prime in edge.guard.primes if (words := _deed(fspa, prime))
    ]
    distinct = list(dict.fromkeys(found))
    if distinct and all(each.startswith(REACHES) for each in distinct):
        return REACHES + " or ".join(each.removeprefix(REACHES) for each in distinct)
    return " or ".join(distinct) or MEETS


def _deed(fspa: Fspa, prime: Implicant) -> str:
    """What makes a prime implicant true: where one is to go somewhere, that alone; what is to hold before what is not
    to; of what is kept, nothing.
    """
    asked = [(atom, holds) for atom, holds in prime if not _is_kept(fspa, atom, holds)]
    if targets := [f"`{target}`" for atom, holds in asked if holds and (target := target_of(fspa, atom))]:
        return f"{REACHES}{' and '.join(targets)}"
    for truth in (True, False):
        if wanted := [atom for atom, holds in asked if holds == truth]:
            return f"makes {' and '.join(f'`{fspa.atoms[atom].name}`' for atom in wanted)} {str(truth).lower()}"
    return ""


def deed_of_all(fspa: Fspa, states: Collection[int], distance: int) -> str:
    """What leads from these states, all of one distance to acceptance, nearer to it; where that is not the same in all
    of them, how near.
    """
    deeds = {deed(fspa, state) for state in states}
    if len(deeds) == 1:
        return deeds.pop()
    left = f"{distance - 1} transition{'s' * (distance > 2)}"
    return f"comes within {left} of acceptance" if distance > 1 else MEETS


def _is_kept(fspa: Fspa, atom: int, truth: bool) -> bool:
    """Whether all accepting runs need that an atom holds, or does not, all the time: every edge to no trap asks it."""
    kept = [edge for edge in fspa.edges if fspa.states[edge.target].distance is not None]
    return all((atom, truth) in prime for edge in kept for prime in edge.guard.primes)


def together(deeds: Sequence[str]) -> str:
    """Several deeds, one after the other: ``reaches `s1`, `s2```; with a choice among them ``reaches `s1`, then `a` or
    `b```.
    """
    between = ", then " if any(" or " in each for each in deeds) else ", "
    if deeds and all(each.startswith(REACHES) for each in deeds):
        return REACHES + between.join(each.removeprefix(REACHES) for each in deeds)
    return between.join(deeds)
