"""The stages of a spec: what to do next in a state of its automaton, in terms of its atoms."""

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
"""The prefix of the description of a stage that is reached at an entity."""

MEETS: Final = "meets the spec"

_FAR: Final = 1e4
"""A distance, in metres, that is greater than any level."""

_PRECISION: Final = 1e-4
"""The precision, in metres, of :func:`near_enough`."""


def target_of(fspa: Fspa, atom: int) -> str | None:
    """The entity that the player must approach for an atom to hold; None unless the atom depends on just that."""
    expression = fspa.atoms[atom].expression
    names = {node.name for node in nodes(expression) if isinstance(node, Signal)}
    if len(names) != 1:
        return None
    (name,) = names
    near, far = (_holds(fspa, expression, name, metres) for metres in (0.0, _FAR))
    return distance_signals(fspa).get(name) if near and not far else None


def near_enough(fspa: Fspa, atom: int, params: Mapping[str, float]) -> float | None:
    """The distance, in metres, below which an atom with a target holds.

    None if the atom has no target or depends on parameters that are not in ``params``.
    """
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
    """Describe what leads from a state towards acceptance.

    For example ``reaches `s1```, ``reaches `a` or `b``` or ``makes `open` true``.
    """
    descriptions = [
        words for edge in tables(fspa).improving[state] for prime in edge.guard.primes if (words := _deed(fspa, prime))
    ]
    distinct = list(dict.fromkeys(descriptions))
    if distinct and all(description.startswith(REACHES) for description in distinct):
        return REACHES + " or ".join(description.removeprefix(REACHES) for description in distinct)
    return " or ".join(distinct) or MEETS


def _deed(fspa: Fspa, prime: Implicant) -> str:
    """Describe what makes a prime implicant true.

    Targets come first and are named alone; otherwise the atoms that must hold; otherwise the atoms
    that must not hold.  Literals that every accepting run needs all the time are left out.
    """
    literals = [(atom, holds) for atom, holds in prime if not _is_kept(fspa, atom, holds)]
    if targets := [f"`{target}`" for atom, holds in literals if holds and (target := target_of(fspa, atom))]:
        return f"{REACHES}{' and '.join(targets)}"
    for truth in (True, False):
        if wanted := [atom for atom, holds in literals if holds == truth]:
            return f"makes {' and '.join(f'`{fspa.atoms[atom].name}`' for atom in wanted)} {str(truth).lower()}"
    return ""


def deed_of_all(fspa: Fspa, states: Collection[int], distance: int) -> str:
    """Describe what leads from these states, all at the same distance, towards acceptance.

    If the descriptions differ, say how near to acceptance it leads.
    """
    deeds = {deed(fspa, state) for state in states}
    if len(deeds) == 1:
        return deeds.pop()
    left = f"{distance - 1} transition{'s' * (distance > 2)}"
    return f"comes within {left} of acceptance" if distance > 1 else MEETS


def _is_kept(fspa: Fspa, atom: int, truth: bool) -> bool:
    """Whether accepting runs need this truth value of an atom all the time.

    This is so if every edge that does not lead to a trap requires it.
    """
    useful_edges = [edge for edge in fspa.edges if fspa.states[edge.target].distance is not None]
    return all((atom, truth) in prime for edge in useful_edges for prime in edge.guard.primes)


def together(deeds: Sequence[str]) -> str:
    """Join descriptions of successive stages: ``reaches `s1`, `s2```.

    If one of them contains a choice: ``reaches `s1`, then `a` or `b```.
    """
    between = ", then " if any(" or " in description for description in deeds) else ", "
    if deeds and all(description.startswith(REACHES) for description in deeds):
        return REACHES + between.join(description.removeprefix(REACHES) for description in deeds)
    return between.join(deeds)
