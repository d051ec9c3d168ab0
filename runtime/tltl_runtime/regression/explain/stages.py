"""The subgoals of a spec: what a player must do to leave a state of its automaton towards acceptance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, Literal

from tltl_runtime.game.mentions import Mentions, union
from tltl_runtime.regression.explain.phrase import Phrase, quoted_names
from tltl_runtime.spec.goals import distance_signals
from tltlc.api import EMPTY, Fspa, Implicant, expressions, monitors, record

_REACHES: Final = "reaches "

_Kind = Literal["reach", "true", "false"]
"""What to do with names: reach these entities, or make these atoms true or false."""

_MOST_ALTERNATIVES: Final = 2
"""Alternatives that name several things at once are listed only up to this number of them."""

_FAR: Final = 1e4
"""A distance, in metres, that is greater than any distance in a level."""

_PRECISION: Final = 1e-4
"""The precision, in metres, of :func:`near_enough`."""


@record
class Subgoal:
    """What the player must do so that the automaton leaves a state for a state nearer to acceptance.

    Either ``targets`` are the entities to reach, as alternatives: ``(("a", "b"), ("c",))`` means both
    ``a`` and ``b``, or ``c``. Or ``other`` says in words what to do, for example ``makes `open` true``.
    The field that does not apply is empty.
    """

    targets: tuple[tuple[str, ...], ...] = ()
    other: str = ""
    is_choice: bool = False
    """Whether the subgoal has alternatives, one of which is enough."""

    @property
    def text(self) -> str:
        """The subgoal in words, for example ``reaches `s1``` or ``makes `open` true``."""
        return f"{_REACHES}{self.place}" if self.targets else self.other

    @property
    def place(self) -> str:
        """The entities to reach in words, for example ```a` or `b```; empty if there are none."""
        return _alternatives(self.targets)

    @property
    def mentions(self) -> Mentions:
        """The entities to reach, as names that the text mentions."""
        return Mentions(tuple(target for together in self.targets for target in together))


def _alternatives(groups: Sequence[Sequence[str]]) -> str:
    """List groups of names of which one group is enough: ```a` or `b```, ```a`, or both `b` and `c```."""
    texts = [quoted_names(names) for names in groups]
    if all(len(names) == 1 for names in groups):
        return f"{', '.join(texts[:-1])} or {texts[-1]}" if len(texts) > 1 else "".join(texts)
    if len(texts) > 1:
        quantity = {1: "", 2: "both "}
        texts = [f"{quantity.get(len(names), 'all of ')}{text}" for names, text in zip(groups, texts, strict=True)]
    return ", or ".join(texts)


MEETS: Final = Subgoal(other="meets the spec")


def last_steps(distance: int) -> Subgoal:
    """Return the subgoal to come from a state at ``distance`` from acceptance to the next distance.

    For example, ``comes to the last 2 steps of the spec``; at distance 1, ``meets the spec``.
    """
    if distance == 1:
        return MEETS
    left = distance - 1
    return Subgoal(other=f"comes to the last {'step' if left == 1 else f'{left} steps'} of the spec")


def target_of(fspa: Fspa, atom: int) -> str | None:
    """Return the target of an atom: the entity that the player must approach to make the atom true.

    ``atom`` is the index of the atom. An atom has a target if it depends on one signal only, the
    distance to an entity, and if it holds at distance 0 but not far away. None if it has no target.
    """
    expression = fspa.atoms[atom].expression
    names = {node.name for node in expressions.nodes(expression) if isinstance(node, expressions.SignalValue)}
    if len(names) != 1:
        return None
    (name,) = names
    near, far = (_holds(fspa, expression, name, metres) for metres in (0.0, _FAR))
    return distance_signals(fspa).get(name) if near and not far else None


def distance_column(fspa: Fspa, target: str) -> int:
    """Return the index of the signal ``distance(TARGET)`` among the signals of the spec; it must exist."""
    return next(
        index for index, signal in enumerate(fspa.signals) if (signal.base, signal.arguments) == ("distance", (target,))
    )


def near_enough(fspa: Fspa, atom: int, params: Mapping[str, float]) -> float | None:
    """Return the distance to an atom's target, in metres, below which the atom holds.

    ``atom`` is the index of the atom. ``params`` are values of the spec's params, in SI units. Return
    None if the atom has no target (see :func:`target_of`), or depends on a param that is not in
    ``params``.
    """
    target, expression = target_of(fspa, atom), fspa.atoms[atom].expression
    if (
        target is None
        or {node.name for node in expressions.nodes(expression) if isinstance(node, expressions.ParamValue)}
        - params.keys()
    ):
        return None
    distance = fspa.signals[distance_column(fspa, target)].name
    near, far = 0.0, _FAR
    while far - near > _PRECISION:
        middle = (near + far) / 2
        near, far = (middle, far) if _holds(fspa, expression, distance, middle, params) else (near, middle)
    return far


def _holds(
    fspa: Fspa, expression: expressions.Expression, distance: str, metres: float, params: Mapping[str, float] = EMPTY
) -> bool:
    values = {**{param.name: param.value for param in fspa.params}, **params}
    try:
        return expressions.evaluate(expression, {distance: metres}, values) > 0.0
    except (ArithmeticError, ValueError):
        return False


def subgoal(fspa: Fspa, state: int) -> Subgoal:
    """Return the subgoal of a state: what the player must do to leave it towards acceptance.

    If several things do so, they are alternatives. If nothing is left to do, or if no edge leads
    towards acceptance, the text of the subgoal is ``meets the spec``. If there are too many alternatives
    to read, the subgoal counts the steps of the spec that are left.
    """
    ways = [_way(fspa, prime) for edge in monitors.tables(fspa).improving[state] for prime in edge.guard.primes]
    distinct = list(dict.fromkeys(way for way in ways if way is not None))
    if not distinct:
        return MEETS
    if len(distinct) > _MOST_ALTERNATIVES and any(len(names) > 1 for _, names in distinct):
        return last_steps(fspa.states[state].distance or 1)
    groups = {kind: tuple(names for way_kind, names in distinct if way_kind == kind) for kind, _ in distinct}
    is_choice = len(distinct) > 1
    if groups.keys() == {"reach"}:
        return Subgoal(groups["reach"], is_choice=is_choice)
    return Subgoal(other=" or ".join(_kind_text(*group) for group in groups.items()), is_choice=is_choice)


def _kind_text(kind: _Kind, groups: Sequence[Sequence[str]]) -> str:
    """Return a text such as ``makes `a` or `b` true`` for alternatives of one kind."""
    names = _alternatives(groups)
    comma = "," * (len(groups) > 1 and any(len(together) > 1 for together in groups))
    return f"{_REACHES}{names}" if kind == "reach" else f"makes {names}{comma} {kind}"


def _way(fspa: Fspa, prime: Implicant) -> tuple[_Kind, tuple[str, ...]] | None:
    """Return what the player must do to make a prime implicant true; None if there is nothing to do.

    Literals that every accepting run needs all the time are left out. Of the other literals, only
    the first of these kinds that occurs is named:

    1. ``reach``: the entities to approach for atoms that must hold (see :func:`target_of`);
    2. ``true``: other atoms that must hold;
    3. ``false``: atoms that must not hold.
    """
    literals = [(atom, holds) for atom, holds in prime if not _is_invariant(fspa, atom, holds)]
    if targets := [target for atom, holds in literals if holds and (target := target_of(fspa, atom))]:
        return "reach", tuple(targets)
    names = [literal_name(fspa, *literal) for literal in literals]
    if made_true := tuple(name for name, holds in names if holds):
        return "true", made_true
    made_false = tuple(name for name, holds in names if not holds)
    return ("false", made_false) if made_false else None


def literal_name(fspa: Fspa, atom: int, holds: bool) -> tuple[str, bool]:
    """Return the text of an atom and whether it must hold: ``x >= 7`` that holds for ``x < 7`` that does not.

    ``atom`` is the index of the atom, and ``holds`` whether it must hold.
    """
    opposite = fspa.atoms[atom].opposite
    return (fspa.atoms[atom].name, holds) if holds or opposite is None else (opposite, True)


def is_opposite_asked(fspa: Fspa, atom: int) -> bool:
    """Whether a goal asks for the opposite of a comparison, as ``reach x >= 7`` does of the atom ``x < 7``.

    ``atom`` is the index of the atom. Clauses that hold at all steps, such as ``avoid x < 7``, do not count.
    """
    if fspa.atoms[atom].opposite is None or _is_invariant(fspa, atom, False):
        return False
    primes = (prime for edges in monitors.tables(fspa).improving for edge in edges for prime in edge.guard.primes)
    return {truth for prime in primes for literal, truth in prime if literal == atom} == {False}


def _is_invariant(fspa: Fspa, atom: int, truth: bool) -> bool:
    """Whether every accepting run needs the value ``truth`` of an atom at all steps.

    This is so if the guards of all edges require the value, except for edges into traps.
    """
    useful_edges = [edge for edge in fspa.edges if fspa.states[edge.target].distance is not None]
    return all((atom, truth) in prime for edge in useful_edges for prime in edge.guard.primes)


def subgoals_phrase(subgoals: Sequence[Subgoal]) -> Phrase:
    """Describe successive subgoals: ``reaches `s1`, `s2```.

    If one of them has alternatives, ``then`` separates them: ``reaches `s1`, then `a` or `b```.
    """
    between = ", then " if any(subgoal.is_choice for subgoal in subgoals) else ", "
    if subgoals and all(subgoal.targets for subgoal in subgoals):
        text = _REACHES + between.join(subgoal.place for subgoal in subgoals)
    else:
        text = between.join(subgoal.text for subgoal in subgoals)
    return Phrase(text, union(subgoal.mentions for subgoal in subgoals))
