"""The check of a level of the stealth game against specs."""

from __future__ import annotations

from collections.abc import Iterator

from gymnasium import spaces

from tltl_runtime.game.level_check import LevelCheck, SensedPart
from tltl_runtime.game.level_name import Variant
from tltl_runtime.game.sensors import SensorChoice
from tltl_runtime.spec.spec_places import SpecPlaces
from tltl_runtime.stealth.capabilities.capabilities import check_capabilities, params_from_level, used_entities
from tltl_runtime.stealth.capabilities.feasible import check_height, check_reach
from tltl_runtime.stealth.capabilities.reach import compute_reach
from tltl_runtime.stealth.levels.file import read_level
from tltl_runtime.stealth.observation.observation import Observer
from tltlc.api import Diagnostic, Fspa, Spec


class StealthLevelCheck(LevelCheck):
    """Reads one variant of a level, and computes what a player can reach in it.

    ``sensors`` replace some or all of the level's own.

    Raises:
        TltlError: the level cannot be read, or is too large to search; it lacks something that
            ``sensors`` names.
    """

    def __init__(self, name: str, variant: str | Variant, sensors: SensorChoice | None) -> None:
        self._level, level_warnings = read_level(name, variant)
        self._observer, self._reach = Observer(self._level, sensors), compute_reach(self._level)
        self.name = self._level.name
        self.spec = self._level.spec.text if self._level.spec else None
        self.warnings = (*level_warnings, *check_height(self._level, self._reach))
        self.sensed = tuple(_sensed_parts(self._observer))

    def diagnostics(self, fspa: Fspa, spec: Spec | None) -> list[Diagnostic]:
        """Return diagnostics about what a spec needs and the level lacks.

        If none of them is an error, also return a diagnostic for each entity of the spec that no
        player can reach. ``spec``, from which ``fspa`` was made, gives the places in the source;
        None if there is no source.
        """
        places = SpecPlaces(spec)
        diagnostics = check_capabilities(self._level, fspa, places)
        if not any(diagnostic.severity == "error" for diagnostic in diagnostics):
            diagnostics += check_reach(self._level, self._reach, fspa, places)
        return diagnostics

    def supplied(self, fspa: Fspa) -> tuple[str, ...]:
        """Return what the level supplies to a spec, as texts.

        These are the entities that the spec uses, its signals without arguments, and its
        parameters: ``("exit", "health", "level_size = 31.2 m")``.
        """
        names = list(used_entities(self._level, fspa))
        names += [signal.name for signal in fspa.signals if not signal.arguments]
        names += [f"{name} = {value:.4g} m" for name, value in params_from_level(self._level, fspa).items()]
        return tuple(names)

    def picture(self) -> bytes:
        """Return the plan of the level (a map from above) as a PNG, with red where nobody can stand."""
        from tltl_runtime.stealth.rendering.plan import draw_level

        return draw_level(self._level, self._reach)


def _sensed_parts(observer: Observer) -> Iterator[SensedPart]:
    """Yield the parts of the observation that depend on the level, with their shapes and names."""
    sensors = observer.sensors
    names = {
        "entities": sensors.entities,
        "variables": sensors.variables,
        "map": sensors.map.types if sensors.map else (),
    }
    for key, space in observer.space.spaces.items():
        if isinstance(space, spaces.Box):
            yield SensedPart(key, space.shape, names[key])
