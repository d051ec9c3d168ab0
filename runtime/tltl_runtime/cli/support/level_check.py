"""``tltlc check --level``: check whether levels supply what specs need."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import click
from gymnasium import spaces

from tltl_runtime.cli.support.sensor_options import sensor_options
from tltl_runtime.game.level_name import split_level
from tltl_runtime.spec.spec_places import SpecPlaces
from tltl_runtime.stealth.capabilities.capabilities import check_capabilities, params_from_level, used_entities
from tltl_runtime.stealth.capabilities.feasible import check_height, check_reach
from tltl_runtime.stealth.capabilities.reach import Reach, compute_reach
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.levels.file import level_names, read_level, variants
from tltl_runtime.stealth.observation.observation import Observer
from tltl_runtime.support.path_text import path_text
from tltlc.api import Diagnostic, Fspa, TltlError, cli, fileio


@click.command()
@sensor_options
@click.option(
    "--plan",
    metavar="FILE.png",
    type=cli.OutputPath("file"),
    help="Draw a plan of the level, with red where nobody can stand. For one level and variant.",
)
def command(
    levels: tuple[str, ...],
    inputs: Sequence[cli.Input],
    settings: cli.CompileSettings,
    report: cli.Report,
    sensors: Mapping[str, Any],
    plan: Path | None,
) -> None:
    """Check levels against the compiled specs ``inputs``; without these, check each against its own spec."""
    if plan is not None and plan.suffix.lower() != ".png":
        raise click.UsageError(f"--plan writes a .png file, not `{plan}`", click.get_current_context())
    check = _LevelCheck(inputs, settings, report, sensors)
    checked: list[tuple[StealthLevel, Reach]] = []
    for path, variant in map(split_level, levels):
        for name in level_names() if path == "all" else (path,):
            try:
                checked += [check(name, variant_name) for variant_name in ((variant,) if variant else variants(name))]
            except TltlError as error:
                report.add(error.diagnostics)
    if plan is not None and checked:
        _draw(plan, checked)


class _LevelCheck:
    """Checks levels. It reports each message only once, even if it applies to several variants."""

    def __init__(
        self, inputs: Sequence[cli.Input], settings: cli.CompileSettings, report: cli.Report, sensors: Mapping[str, Any]
    ) -> None:
        self._inputs, self._settings, self._report, self._sensors = inputs, settings, report, sensors
        self._reported: set[object] = set()

    def __call__(self, path: str, variant: str) -> tuple[StealthLevel, Reach]:
        """Check one variant of a level and report the messages; return the level and what can be reached in it."""
        level, level_warnings = read_level(path, variant)
        observer, reach = Observer(level, self._sensors), compute_reach(level)
        warnings = [*level_warnings, *check_height(level, reach)]
        self._add(warnings)
        inputs = self._inputs or self._compile_own_spec(level)
        has_several = len(inputs) > 1 or any(len(opened.automata) > 1 for opened in inputs)
        for opened in inputs:
            for fspa, places in _specs(opened):
                diagnostics = check_capabilities(level, fspa, places)
                if cli.status_of(diagnostics) == cli.CLEAN:
                    diagnostics += check_reach(level, reach, fspa, places)
                self._add(diagnostics)
                if not diagnostics:
                    receiver = f" to `{fspa.name}`" if has_several else ""
                    note = "" if warnings or opened.diagnostics else " (nothing to report)"
                    self._say(f"{level.name}:{variant} {_capability_text(level, fspa)}{receiver}{note}")
        self._say(f"{level.name}: the agent senses {_sensor_text(observer)}")
        return level, reach

    def _compile_own_spec(self, level: StealthLevel) -> list[cli.Input]:
        """Compile the spec that a level is made for."""
        if level.spec is None:
            advice = 'name one before --level, or in the level: `spec = "FILE.tltl:NAME"`'
            self._say(f"{level.name}: the level does not name a spec; {advice}")
            return []
        opened = cli.open_input(path_text(Path(level.spec.text)), self._settings)
        self._add(opened.diagnostics)
        return [opened]

    def _add(self, diagnostics: Iterable[Diagnostic]) -> None:
        new = [diagnostic for diagnostic in diagnostics if diagnostic not in self._reported]
        self._reported.update(new)
        self._report.add(new)

    def _say(self, line: str) -> None:
        if line not in self._reported:
            self._reported.add(line)
            self._report.say(line)


def _draw(path: Path, checked: list[tuple[StealthLevel, Reach]]) -> None:
    if len(checked) != 1:
        expected = "one level and variant, e.g. `--level navigation:v2`"
        raise click.UsageError(f"--plan needs {expected}, not {len(checked)}", click.get_current_context())
    from tltl_runtime.stealth.rendering.plan import draw_level

    level, reach = checked[0]
    fileio.write_file(path, draw_level(level, reach), "name another place with --plan")


def _specs(opened: cli.Input) -> Iterator[tuple[Fspa, SpecPlaces]]:
    specs = {spec.name: spec for spec in opened.program.specs} if opened.program else {}
    for fspa in opened.automata:
        yield fspa, SpecPlaces(specs.get(fspa.name))


def _capability_text(level: StealthLevel, fspa: Fspa) -> str:
    """Say what a level supplies to a spec, for example ``supplies s1, exit``.

    These are the entities and params that the spec uses, and its signals that are about no entity.
    """
    names = list(used_entities(level, fspa))
    names += [signal.name for signal in fspa.signals if not signal.arguments]
    names += [f"{name} = {value:.4g} m" for name, value in params_from_level(level, fspa).items()]
    return f"supplies {', '.join(names)}" if names else "has nothing to supply"


def _sensor_text(observer: Observer) -> str:
    """Describe the parts of the observation that depend on the level, with their sizes."""
    sensors = observer.sensors
    names = {
        "entities": sensors.entities,
        "variables": sensors.variables,
        "map": sensors.map.types if sensors.map else (),
    }
    parts = [
        f"{key} {' x '.join(map(str, space.shape))} ({', '.join(names[key])})"
        for key, space in observer.space.spaces.items()
        if isinstance(space, spaces.Box)
    ]
    return "; ".join(parts) or "nothing of the level"
