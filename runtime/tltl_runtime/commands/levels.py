"""What ``tltlc check --level`` says: of each level and variant, whether it has what the specs speak of."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import click
from gymnasium import spaces

from tltl_runtime.commands.senses import senses_options
from tltl_runtime.stealth.feasible import check_reach
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.level_file import level_names, read_level, variants
from tltl_runtime.stealth.observation import Senses
from tltl_runtime.stealth.reach import reachable
from tltl_runtime.stealth.spec_places import SpecPlaces
from tltl_runtime.stealth.supply import check_supply, given_params, used_entities
from tltlc.automaton.fspa import Fspa
from tltlc.cli.exits import CLEAN, status_of
from tltlc.cli.inputs import Input, open_input
from tltlc.cli.report import Report
from tltlc.cli.settings import Settings
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.spec_file import split


@click.command()
@senses_options
def command(
    levels: tuple[str, ...],
    inputs: Sequence[Input],
    settings: Settings,
    report: Report,
    sensors: Mapping[str, Any],
) -> None:
    """Hold levels against compiled specs, or where there are none against the spec that each is made for."""
    for argument in levels:
        for name in level_names() if argument == "all" else (argument,):
            try:
                _check(name, inputs, settings, report, sensors)
            except TltlError as error:
                report.add(error.diagnostics)


def _check(
    argument: str, inputs: Sequence[Input], settings: Settings, report: Report, sensors: Mapping[str, Any]
) -> None:
    """All that is to be said of one level; what holds of several of its variants is said once."""
    path, variant = split(argument)
    said: set[object] = set()
    for each in (variant,) if variant else variants(path):
        level, warnings = read_level(path, each)
        _add(report, warnings, said)
        senses = Senses(level, sensors)
        reach = reachable(level)
        for opened in inputs or _own(level, settings, report, said):
            for fspa, places in _specs(opened):
                found = check_supply(level, fspa, places)
                if status_of(found) == CLEAN:
                    found += check_reach(level, reach, fspa, places)
                _add(report, found, said)
                if not found:
                    several = f" to `{fspa.name}`" if len(inputs) > 1 or len(opened.automata) > 1 else ""
                    report.say(f"{level.name}:{each} supplies {_supplied(level, fspa)}{several} (nothing to report)")
        if (line := f"{level.name}: the agent senses {_sensed(senses)}") not in said:
            said.add(line)
            report.say(line)


def _own(level: Level, settings: Settings, report: Report, said: set[object]) -> list[Input]:
    """The spec that a level is made for, compiled."""
    if not level.spec:
        if "no spec" not in said:
            said.add("no spec")
            report.say(
                f'{level.name}: made for no spec; name one before --level, or in the level: `spec = "FILE.tltl:NAME"`'
            )
        return []
    opened = open_input(_shown(level.spec), settings)
    _add(report, opened.diagnostics, said)
    return [opened]


def _shown(spec: str) -> str:
    """A path with a name, relative to the current folder where it lies inside."""
    try:
        return str(Path(spec).relative_to(Path.cwd()))
    except ValueError:
        return spec


def _add(report: Report, diagnostics: Iterable[Diagnostic], said: set[object]) -> None:
    """Report what has not been said."""
    new = [diagnostic for diagnostic in diagnostics if diagnostic not in said]
    said.update(new)
    report.add(new)


def _specs(opened: Input) -> Iterator[tuple[Fspa, SpecPlaces]]:
    specs = {spec.name: spec for spec in opened.program.specs} if opened.program else {}
    for fspa in opened.automata:
        yield fspa, SpecPlaces(specs.get(fspa.name))


def _supplied(level: Level, fspa: Fspa) -> str:
    """The entities, the signals that are of none, and the params that a spec gets from a level."""
    names = list(used_entities(level, fspa))
    names += [signal.name for signal in fspa.signals if "(" not in signal.name]
    names += [f"{name} = {value:.4g} m" for name, value in given_params(level, fspa).items()]
    return ", ".join(names) or "all that it needs, which is nothing,"


def _sensed(senses: Senses) -> str:
    """The parts of the observation that are of the level, with their sizes."""
    own = senses.sensors
    names = {"entities": own.entities, "variables": own.variables, "map": own.map.types if own.map else ()}
    shown = [
        f"{key} {' x '.join(map(str, space.shape))} ({', '.join(names[key])})"
        for key, space in senses.space.spaces.items()
        if isinstance(space, spaces.Box)
    ]
    return "; ".join(shown) or "nothing of the level"
