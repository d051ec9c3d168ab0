"""``tltlc check --level``: check whether levels supply what specs need."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from tltl_runtime.cli.support.sensor_options import sensor_options
from tltl_runtime.game.capability_error import capability_error
from tltl_runtime.game.level_check import LevelCheck
from tltl_runtime.game.level_name import split_level
from tltl_runtime.game.registry import game_of, shipped_levels
from tltl_runtime.gymnasium_games.level_scenes import level_of_scene
from tltl_runtime.support.path_text import path_text
from tltlc.api import Diagnostic, Fspa, Spec, TltlError, cli, fileio


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
    checked = check_levels(levels, inputs, settings, report, sensors)
    if plan is not None and checked:
        _draw(plan, checked)
        report.say(f"wrote {plan}")


def check_levels(
    levels: Iterable[str],
    inputs: Sequence[cli.Input],
    settings: cli.CompileSettings,
    report: cli.Report,
    sensors: Mapping[str, Any],
) -> list[LevelCheck]:
    """Check levels against the compiled specs ``inputs``; without these, check each against its own spec.

    ``levels`` are arguments of ``--level``, or scenes that stand for levels. ``sensors`` are those that
    options set. Return the checks of all levels and variants that can be read.
    """
    check = _LevelReport(inputs, settings, report, sensors)
    checked: list[LevelCheck] = []
    for path, variant in map(split_level, map(level_of_scene, levels)):
        for name in shipped_levels() if path == "all" else (path,):
            try:
                variants = (variant,) if variant else game_of(name).level_files.variants(name)
                checked += [check(name, variant_name) for variant_name in variants]
            except TltlError as error:
                report.add(error.diagnostics)
    return checked


class _LevelReport:
    """Checks levels. It reports each message only once, even if it applies to several variants."""

    def __init__(
        self, inputs: Sequence[cli.Input], settings: cli.CompileSettings, report: cli.Report, sensors: Mapping[str, Any]
    ) -> None:
        self._inputs, self._settings, self._report, self._sensors = inputs, settings, report, sensors
        self._reported: set[object] = set()

    def __call__(self, path: str, variant: str) -> LevelCheck:
        """Check one variant of a level and report the messages; return the check.

        Raises:
            TltlError: the level cannot be read; TLT0731, its game cannot check levels.
        """
        game = game_of(path)
        check = game.level_check(path, variant, self._sensors)
        if check is None:
            advice = "`tltlc check SPEC` checks a spec without a level"
            raise capability_error(game.load_level(path, variant), "cannot check its levels", advice)
        self._add(check.warnings)
        inputs = self._inputs or self._compile_own_spec(check)
        has_several = len(inputs) > 1 or any(len(opened.automata) > 1 for opened in inputs)
        for opened in inputs:
            for fspa, spec in _specs(opened):
                diagnostics = check.diagnostics(fspa, spec)
                self._add(diagnostics)
                if not diagnostics:
                    receiver = f" to `{fspa.name}`" if has_several else ""
                    note = "" if check.warnings or opened.diagnostics else " (nothing to report)"
                    self._say(f"{check.name}:{variant} {_supply_text(check, fspa)}{receiver}{note}")
        self._say(f"{check.name}: the agent senses {_sensor_text(check)}")
        return check

    def _compile_own_spec(self, check: LevelCheck) -> list[cli.Input]:
        """Compile the spec that a level is made for; return no input if it names none."""
        if check.spec is None:
            advice = 'name one before --level, or in the level: `spec = "FILE.tltl:NAME"`'
            self._say(f"{check.name}: the level does not name a spec; {advice}")
            return []
        opened = cli.open_input(path_text(Path(check.spec)), self._settings)
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


def _draw(path: Path, checked: list[LevelCheck]) -> None:
    if len(checked) != 1:
        expected = "one level and variant, e.g. `--level navigation:v2`"
        raise click.UsageError(f"--plan needs {expected}, not {len(checked)}", click.get_current_context())
    fileio.write_file(path, checked[0].picture(), "name another place with --plan")


def _specs(opened: cli.Input) -> Iterator[tuple[Fspa, Spec | None]]:
    """Yield each automaton of an input with the spec that it was made from.

    The spec is None if the input is a compiled artefact, which has no source.
    """
    specs = {spec.name: spec for spec in opened.program.specs} if opened.program else {}
    for fspa in opened.automata:
        yield fspa, specs.get(fspa.name)


def _supply_text(check: LevelCheck, fspa: Fspa) -> str:
    """Say what a level supplies to a spec, for example ``supplies s1, exit``."""
    names = check.supplied(fspa)
    return f"supplies {', '.join(names)}" if names else "has nothing to supply"


def _sensor_text(check: LevelCheck) -> str:
    """Describe the parts of the observation that depend on the level, with their sizes."""
    parts = [f"{part.key} {' x '.join(map(str, part.shape))} ({', '.join(part.names)})" for part in check.sensed]
    return "; ".join(parts) or "nothing of the level"
