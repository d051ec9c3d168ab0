"""Whether anybody can do in a level what a spec asks, as far as it depends on what can be reached there."""

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
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, Severity, TltlError
from tltlc.expression.tree import Expression, Param, Signal
from tltlc.io.limits import WORK
from tltlc.resolve.range_proof.cases import TooManyCasesError, cases
from tltlc.resolve.range_proof.interval import Interval, UndefinedError
from tltlc.resolve.range_proof.region import Region, Variable, bound

_TALLER: Final = 0.25
"""By so many metres jumps get higher, until one leads past what is in the way."""


def check_reach(level: Level, reach: Reach, fspa: Fspa, places: SpecPlaces) -> list[Diagnostic]:
    """TLT0814 for each entity of a spec that nobody gets near to, as an error where the spec cannot be met without it.

    The level supplies all that the spec speaks of.
    """
    far = [name for name in used_entities(level, fspa) if not reach.reaches(name)]
    if not far:
        return []
    doable = _doable(fspa, _impossible(level, reach, fspa))
    ways = _Ways(level, reach)
    found = []
    for name in far:
        title = f"nobody reaches `{name}` in `{level.name}:{level.variant}`"
        title += "" if doable else f", so nobody can do what `{fspa.name}` asks"
        severity: Severity = "warning" if doable else "error"
        found.append(Diagnostic("TLT0814", title, places.entity(name), ways.end(name), severity))
    return found


def check_height(level: Level, reach: Reach) -> list[Diagnostic]:
    """A warning TLT0806 where a jump may lead out of a level: that would end the episode with an error."""
    jump = reach.highest + highest_jump(PlayerKind())
    top = level.bounds.high[2]
    if jump <= top:
        return []
    title = (
        f"a jump may lead out of `{level.name}`: one gets {reach.highest:.3g} m high, and its bounds end at {top:g} m"
    )
    return [Diagnostic("TLT0806", title, help=f"let them end above {jump + 0.01:.2f} m", severity="warning")]


def reach_warnings(level: Level, fspa: Fspa) -> list[Diagnostic]:
    """:func:`check_reach` for who is about to play, as warnings: one may well play what cannot be finished.

    A level that is too large to be searched gives a warning, too, TLT0006.
    """
    try:
        found: Iterable[Diagnostic] = check_reach(level, reachable(level), fspa, SpecPlaces(None))
    except TltlError as error:
        found = error.diagnostics
    return [replace(each, severity="warning") for each in found]


def _impossible(level: Level, reach: Reach, fspa: Fspa) -> frozenset[int]:
    """The atoms that hold nowhere that can be reached, by index."""
    offered = offers(level)
    box: dict[Variable, Interval] = {}
    for signal in fspa.signals:
        offer = offered[signal.name]
        low, high = _ends(offer.low, offer.high)
        entity = signal.name.removeprefix("distance(").removesuffix(")")
        if signal.name == f"distance({entity})":
            low = max(low, reach.distances[entity])
        # A sample outside the declared range counts as the nearest value inside.
        least, most = _ends(signal.low, signal.high)
        box[Signal(signal.name)] = (min(max(low, least), most), min(max(high, least), most))
    given = given_params(level, fspa)
    for param in fspa.params:
        value = given.get(param.name, param.value)
        box[Param(param.name)] = (value, value)
    return frozenset(index for index, atom in enumerate(fspa.atoms) if _highest(atom.expression, box) <= 0.0)


def _ends(low: float | None, high: float | None) -> Interval:
    return -inf if low is None else low, inf if high is None else high


def _highest(expression: Expression, box: Mapping[Variable, Interval]) -> float:
    """A value that an expression does not exceed in a box."""
    highest = -inf
    try:
        for case in cases(expression):
            region = Region(box, {}).where(case.constraints)
            if region is not None:
                highest = max(highest, bound(case.value, region)[1])
    except (TooManyCasesError, UndefinedError):
        return inf
    return highest


def _doable(fspa: Fspa, impossible: frozenset[int]) -> bool:
    """Whether a trace on which these atoms never hold may be accepted."""
    met, waiting = {0}, [0]
    while waiting:
        state = waiting.pop()
        if fspa.states[state].accepting:
            return True
        for edge in fspa.edges_from(state):
            open_ = any(not any(holds and atom in impossible for atom, holds in prime) for prime in edge.guard.primes)
            if open_ and edge.target not in met:
                met.add(edge.target)
                waiting.append(edge.target)
    return False


# --- where the way ends ------------------------------------------------------------------------------


class _Ways:
    """What would be reached in a level if it were another one."""

    def __init__(self, level: Level, reach: Reach) -> None:
        self._level, self._reach = level, reach
        self._higher: dict[float, Reach] = {highest_lift(PlayerKind()): reach}
        self._without: dict[str, Reach] = {}
        self._budget = Budget(WORK["cells of reachable space"])

    def end(self, entity: str) -> str:
        """What is in the way to an entity that nobody reaches, as far as that is found soon."""
        nearest = f"one gets no nearer to it than {self._reach.distances[entity]:.1f} m"
        try:
            return self._shut(entity) or self._too_high(entity) or nearest
        except SpaceBudgetError:
            return nearest

    def _shut(self, entity: str) -> str:
        """The barrier that is in the way, and why it stays shut; nothing where none is."""
        stays = [each for each in self._level.barriers if each.name not in self._reach.barriers]
        chance = {name: (unlock.switch,) for unlock in self._level.unlocks for name in unlock.barriers}
        for barrier in stays:
            switches = barrier.opened_by or chance[barrier.name]
            missing = next((name for name in switches if name not in self._reach.switches), None)
            if barrier.kind == "solid" and missing and self._is_behind(entity, barrier.name):
                where = "which lies behind it" if self._is_behind(missing, barrier.name) else "which nobody reaches"
                return f"`{barrier.name}` stays shut: it is opened by `{missing}`, {where}"
        return ""

    def _too_high(self, entity: str) -> str:
        """The solid that is got over first where jumps are higher and higher; nothing where none is."""
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
        """Whether an entity would be reached without a solid or a barrier."""
        if obstacle not in self._without:
            self._without[obstacle] = reachable(self._level, without=[obstacle], budget=self._budget)
        return self._without[obstacle].reaches(entity)
