"""Check whether a player can reach enough of a level to meet a spec."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import inf
from typing import Final

from tltl_runtime.game.level import UnreachableEntity
from tltl_runtime.spec.spec_places import SpecPlaces
from tltl_runtime.stealth.capabilities.capabilities import params_from_level, used_entities
from tltl_runtime.stealth.capabilities.reach import Reach, compute_reach, highest_jump, highest_lift
from tltl_runtime.stealth.capabilities.space import Budget, SpaceBudgetError
from tltl_runtime.stealth.capabilities.vocabulary import available_signals
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.world.player import PlayerKind
from tltlc.api import Diagnostic, Fspa, Severity, TltlError, expressions, fileio, ranges, replace

_LIFT_STEP: Final = 0.25
"""In each further try, :class:`_ObstacleSearch` lets the player jump this much higher, in metres."""


def check_reach(level: StealthLevel, reach: Reach, fspa: Fspa, places: SpecPlaces) -> list[Diagnostic]:
    """Return a diagnostic (TLT0814) for each entity of a spec that no player can reach.

    The diagnostics are errors if nobody can meet the spec without these entities, else warnings.
    The level must supply everything that the spec uses.
    """
    return [entity.diagnostic for entity in _unreachable_entities(level, reach, fspa, places)]


def unreachable_entities(level: StealthLevel, fspa: Fspa) -> list[UnreachableEntity]:
    """Return the entities of a spec that no player can reach.

    Return an empty list if the level is too large to search. The diagnostics are those of
    :func:`check_reach`.
    """
    try:
        return _unreachable_entities(level, compute_reach(level), fspa, SpecPlaces(None))
    except TltlError:
        return []


def _unreachable_entities(level: StealthLevel, reach: Reach, fspa: Fspa, places: SpecPlaces) -> list[UnreachableEntity]:
    unreachable = [name for name in used_entities(level, fspa) if not reach.reaches(name)]
    if not unreachable:
        return []
    feasible = _may_accept(fspa, _impossible_atoms(level, reach, fspa))
    obstacle_search = _ObstacleSearch(level, reach)
    entities = []
    for name in unreachable:
        title = f"nobody can reach `{name}` in `{level.name}:{level.variant}`"
        title += "" if feasible else f", so nobody can do what `{fspa.name}` asks"
        severity: Severity = "warning" if feasible else "error"
        help_, obstacles = obstacle_search.describe(name)
        diagnostic = Diagnostic("TLT0814", title, places.entity(name), help_, severity)
        entities.append(UnreachableEntity(name, obstacles, diagnostic))
    return entities


def check_height(level: StealthLevel, reach: Reach) -> list[Diagnostic]:
    """Return a warning, TLT0806, if a jump may lead out of a level, else an empty list.

    Leaving the level ends an episode with an error.
    """
    jump = reach.highest + highest_jump(PlayerKind())
    top = level.bounds.high[2]
    if jump <= top:
        return []
    title = (
        f"a jump may lead out of `{level.name}`: "
        f"the player can jump from {reach.highest:.3g} m up to {jump:.3g} m, and the bounds end at {top:g} m"
    )
    return [Diagnostic("TLT0806", title, help=f"make the bounds end above {jump + 0.01:.2f} m", severity="warning")]


def reach_warnings(level: StealthLevel, fspa: Fspa) -> list[Diagnostic]:
    """Return the diagnostics of :func:`check_reach`, all as warnings.

    They are not errors here, because a person may play a level whose spec nobody can meet. If the
    level is too large to search, return TLT0006 as a warning.
    """
    try:
        diagnostics: Iterable[Diagnostic] = check_reach(level, compute_reach(level), fspa, SpecPlaces(None))
    except TltlError as error:
        diagnostics = error.diagnostics
    return [replace(diagnostic, severity="warning") for diagnostic in diagnostics]


def is_infeasible(level: StealthLevel, fspa: Fspa) -> bool:
    """Return whether it is certain that no player can meet the spec; :func:`reach_warnings` says why.

    Return False if the level is too large to search.
    """
    return any(entity.diagnostic.severity == "error" for entity in unreachable_entities(level, fspa))


def _impossible_atoms(level: StealthLevel, reach: Reach, fspa: Fspa) -> frozenset[int]:
    """Return the indices of atoms that hold at no place that a player can reach.

    The result contains only such atoms, but perhaps not all of them.
    """
    available = available_signals(level)
    box: dict[ranges.Variable, ranges.Interval] = {}
    for signal in fspa.signals:
        level_signal = available[signal.name]
        low, high = _ends(level_signal.low, level_signal.high)
        if signal.base == "distance" and len(signal.arguments) == 1:
            low = max(low, reach.distances[signal.arguments[0]])
        # A sample outside the declared range is clamped to it.
        least, most = _ends(signal.low, signal.high)
        box[expressions.SignalValue(signal.name)] = (min(max(low, least), most), min(max(high, least), most))
    for register in fspa.registers:
        box[expressions.SignalValue(register.name)] = _ends(register.low, register.high)
    known_params = params_from_level(level, fspa)
    for param in fspa.params:
        value = known_params.get(param.name, param.value)
        box[expressions.ParamValue(param.name)] = (value, value)
    return frozenset(index for index, atom in enumerate(fspa.atoms) if _upper_bound(atom.expression, box) <= 0.0)


def _ends(low: float | None, high: float | None) -> ranges.Interval:
    return -inf if low is None else low, inf if high is None else high


def _upper_bound(expression: expressions.Expression, box: Mapping[ranges.Variable, ranges.Interval]) -> float:
    """Return an upper bound of an expression, given an interval for each of its variables in ``box``.

    Return infinity if no bound is known.
    """
    highest = -inf
    try:
        for case in ranges.cases(expression):
            region = ranges.ConstrainedBox(box, {}).constrain(case.constraints)
            if region is not None:
                highest = max(highest, ranges.bound(case.value, region)[1])
    except (ranges.TooManyCasesError, ranges.UndefinedError):
        return inf
    return highest


def _may_accept(fspa: Fspa, impossible: frozenset[int]) -> bool:
    """Whether the automaton may accept a trace on which the ``impossible`` atoms never hold."""
    reached, pending = {0}, [0]
    while pending:
        state = pending.pop()
        if fspa.states[state].accepting:
            return True
        for edge in fspa.edges_from(state):
            passable = any(
                not any(holds and atom in impossible for atom, holds in prime) for prime in edge.guard.primes
            )
            if passable and edge.target not in reached:
                reached.add(edge.target)
                pending.append(edge.target)
    return False


# --- what is in the way ------------------------------------------------------------------------------


class _ObstacleSearch:
    """Finds the solid or barrier that keeps the player from an entity.

    The search removes an obstacle from the level, or lets the player jump higher, and checks
    whether the player then reaches the entity.
    """

    def __init__(self, level: StealthLevel, reach: Reach) -> None:
        self._level, self._reach = level, reach
        self._by_lift: dict[float, Reach] = {highest_lift(PlayerKind()): reach}
        self._by_removed: dict[str, Reach] = {}
        self._budget = Budget(fileio.limits.WORK["cells of reachable space"])

    def describe(self, entity: str) -> tuple[str, tuple[str, ...]]:
        """Return a text about what blocks the way to ``entity``, and the names of things in the text.

        No player can reach ``entity``. If no single obstacle blocks the way, or if the search takes
        too long, the text says how near the player gets, and there are no names.
        """
        nearest = f"the player gets no nearer to it than {self._reach.distances[entity]:.1f} m"
        try:
            return self._describe_barrier(entity) or self._describe_high_solid(entity) or (nearest, ())
        except SpaceBudgetError:
            return nearest, ()

    def _describe_barrier(self, entity: str) -> tuple[str, tuple[str, ...]] | None:
        """Return a text about the barrier that blocks the way to ``entity``, and why it stays shut.

        Also return the names of the barrier and of its switch. Return None if no single barrier
        blocks the way.
        """
        shut = [barrier for barrier in self._level.barriers if barrier.name not in self._reach.barriers]
        unlocked_by = {name: (unlock.switch,) for unlock in self._level.unlocks for name in unlock.barriers}
        for barrier in shut:
            switches = barrier.opened_by or unlocked_by[barrier.name]
            missing = next((name for name in switches if name not in self._reach.switches), None)
            if barrier.kind == "solid" and missing and self._is_behind(entity, barrier.name):
                location = "which is behind it" if self._is_behind(missing, barrier.name) else "which nobody can reach"
                text = f"`{barrier.name}` stays shut: it is opened by `{missing}`, {location}"
                return text, (barrier.name, missing)
        return None

    def _describe_high_solid(self, entity: str) -> tuple[str, tuple[str, ...]] | None:
        """Return a text about the solid that blocks the way to ``entity`` because it is too high to jump onto.

        Also return the name of the solid. The search tries ever higher jumps. Return None if there
        is no such solid.
        """
        lift = normal = highest_lift(PlayerKind())
        while lift < self._level.bounds.high[2] and not self._reach_with_lift(lift).reaches(entity):
            lift += _LIFT_STEP
        if self._reach_with_lift(lift).reaches(entity):
            for solid in self._level.solids:
                height = solid.box.high[2] - solid.box.low[2]
                if normal < height <= lift and self._is_behind(entity, solid.name):
                    return f"the way ends at `{solid.name}`, which is {height:g} m high", (solid.name,)
        return None

    def _reach_with_lift(self, lift: float) -> Reach:
        if lift not in self._by_lift:
            self._by_lift[lift] = compute_reach(self._level, lift=lift, budget=self._budget)
        return self._by_lift[lift]

    def _is_behind(self, entity: str, obstacle: str) -> bool:
        """Whether the player could reach ``entity`` if ``obstacle`` were removed.

        ``obstacle`` is the name of a solid or a barrier.
        """
        if obstacle not in self._by_removed:
            self._by_removed[obstacle] = compute_reach(self._level, without=[obstacle], budget=self._budget)
        return self._by_removed[obstacle].reaches(entity)
