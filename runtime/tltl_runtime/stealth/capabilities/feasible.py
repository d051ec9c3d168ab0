"""Check whether a spec can be met in a level, as far as that depends on what can be reached."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import inf
from typing import Final

from tltl_runtime.stealth.capabilities.capabilities import given_params, used_entities
from tltl_runtime.stealth.capabilities.reach import Reach, highest_jump, highest_lift, reachable
from tltl_runtime.stealth.capabilities.space import Budget, SpaceBudgetError
from tltl_runtime.stealth.capabilities.spec_places import SpecPlaces
from tltl_runtime.stealth.capabilities.vocabulary import offers
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.world.player import PlayerKind
from tltlc.api import Diagnostic, Fspa, Severity, TltlError, expressions, fileio, ranges, replace

_TALLER: Final = 0.25
"""The step, in metres, by which jumps are raised in search of the obstacle that is too high."""


def check_reach(level: Level, reach: Reach, fspa: Fspa, places: SpecPlaces) -> list[Diagnostic]:
    """Return TLT0814 for each entity of a spec that cannot be reached.

    It is an error if the spec cannot be met without the entity, else a warning. The level must
    supply everything that the spec uses.
    """
    unreached = [name for name in used_entities(level, fspa) if not reach.reaches(name)]
    if not unreached:
        return []
    feasible = _may_accept(fspa, _impossible(level, reach, fspa))
    ways = _Ways(level, reach)
    diagnostics = []
    for name in unreached:
        title = f"nobody reaches `{name}` in `{level.name}:{level.variant}`"
        title += "" if feasible else f", so nobody can do what `{fspa.name}` asks"
        severity: Severity = "warning" if feasible else "error"
        diagnostics.append(Diagnostic("TLT0814", title, places.entity(name), ways.end(name), severity))
    return diagnostics


def check_height(level: Level, reach: Reach) -> list[Diagnostic]:
    """Return a warning, TLT0806, if a jump may lead out of a level.

    Leaving the level would end the episode with an error.
    """
    jump = reach.highest + highest_jump(PlayerKind())
    top = level.bounds.high[2]
    if jump <= top:
        return []
    title = (
        f"a jump may lead out of `{level.name}`: one gets {reach.highest:.3g} m high, and its bounds end at {top:g} m"
    )
    return [Diagnostic("TLT0806", title, help=f"let them end above {jump + 0.01:.2f} m", severity="warning")]


def reach_warnings(level: Level, fspa: Fspa) -> list[Diagnostic]:
    """Return the results of :func:`check_reach` as warnings, for play.

    A level may be played even if its spec cannot be met. If a level is too large to search, the
    result is a warning, too, TLT0006.
    """
    try:
        diagnostics: Iterable[Diagnostic] = check_reach(level, reachable(level), fspa, SpecPlaces(None))
    except TltlError as error:
        diagnostics = error.diagnostics
    return [replace(diagnostic, severity="warning") for diagnostic in diagnostics]


def is_infeasible(level: Level, fspa: Fspa) -> bool:
    """Return whether no player can meet the spec; :func:`reach_warnings` say why.

    False if the level is too large to be searched.
    """
    try:
        diagnostics = check_reach(level, reachable(level), fspa, SpecPlaces(None))
    except TltlError:
        return False
    return any(diagnostic.severity == "error" for diagnostic in diagnostics)


def _impossible(level: Level, reach: Reach, fspa: Fspa) -> frozenset[int]:
    """The indices of the atoms that cannot hold at any reachable place."""
    offered = offers(level)
    box: dict[ranges.Variable, ranges.Interval] = {}
    for signal in fspa.signals:
        offer = offered[signal.name]
        low, high = _ends(offer.low, offer.high)
        if signal.base == "distance" and len(signal.arguments) == 1:
            low = max(low, reach.distances[signal.arguments[0]])
        # A sample outside the declared range is clamped to it.
        least, most = _ends(signal.low, signal.high)
        box[expressions.SignalValue(signal.name)] = (min(max(low, least), most), min(max(high, least), most))
    known_params = given_params(level, fspa)
    for param in fspa.params:
        value = known_params.get(param.name, param.value)
        box[expressions.ParamValue(param.name)] = (value, value)
    return frozenset(index for index, atom in enumerate(fspa.atoms) if _highest(atom.expression, box) <= 0.0)


def _ends(low: float | None, high: float | None) -> ranges.Interval:
    return -inf if low is None else low, inf if high is None else high


def _highest(expression: expressions.Expression, box: Mapping[ranges.Variable, ranges.Interval]) -> float:
    """An upper bound of an expression in a box."""
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


class _Ways:
    """Finds the obstacle before an entity, by searching changed versions of the level."""

    def __init__(self, level: Level, reach: Reach) -> None:
        self._level, self._reach = level, reach
        self._higher: dict[float, Reach] = {highest_lift(PlayerKind()): reach}
        self._without: dict[str, Reach] = {}
        self._budget = Budget(fileio.limits.WORK["cells of reachable space"])

    def end(self, entity: str) -> str:
        """Describe what blocks the way to an unreachable entity, as far as the budget allows."""
        nearest = f"one gets no nearer to it than {self._reach.distances[entity]:.1f} m"
        try:
            return self._shut(entity) or self._too_high(entity) or nearest
        except SpaceBudgetError:
            return nearest

    def _shut(self, entity: str) -> str:
        """Describe the barrier in the way and why it stays shut; empty if there is none."""
        shut = [barrier for barrier in self._level.barriers if barrier.name not in self._reach.barriers]
        unlocked_by = {name: (unlock.switch,) for unlock in self._level.unlocks for name in unlock.barriers}
        for barrier in shut:
            switches = barrier.opened_by or unlocked_by[barrier.name]
            missing = next((name for name in switches if name not in self._reach.switches), None)
            if barrier.kind == "solid" and missing and self._is_behind(entity, barrier.name):
                location = "which lies behind it" if self._is_behind(missing, barrier.name) else "which nobody reaches"
                return f"`{barrier.name}` stays shut: it is opened by `{missing}`, {location}"
        return ""

    def _too_high(self, entity: str) -> str:
        """Describe the solid that is too high to jump over, or return an empty text.

        It is found by trying ever higher jumps.
        """
        lift = normal = highest_lift(PlayerKind())
        while lift < self._level.bounds.high[2] and not self._jumping(lift).reaches(entity):
            lift += _TALLER
        if self._jumping(lift).reaches(entity):
            for solid in self._level.solids:
                height = solid.box.high[2] - solid.box.low[2]
                if normal < height <= lift and self._is_behind(entity, solid.name):
                    return f"the way ends at `{solid.name}`, which is {height:g} m high"
        return ""

    def _jumping(self, lift: float) -> Reach:
        if lift not in self._higher:
            self._higher[lift] = reachable(self._level, lift=lift, budget=self._budget)
        return self._higher[lift]

    def _is_behind(self, entity: str, obstacle: str) -> bool:
        """Whether an entity could be reached if a solid or barrier were removed."""
        if obstacle not in self._without:
            self._without[obstacle] = reachable(self._level, without=[obstacle], budget=self._budget)
        return self._without[obstacle].reaches(entity)
