"""``tltlc check --game``: play the scenes of games, and check whether they supply what specs need."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any, Final

import click
import numpy as np

from tltl_runtime.cli.support.level_check import check_levels
from tltl_runtime.cli.support.plain_text import plain_text
from tltl_runtime.cli.support.slow_starts import slow_starts_shown
from tltl_runtime.gymnasium_games.capabilities import missing
from tltl_runtime.gymnasium_games.game_argument import parse_game, scene_of, variant_of
from tltl_runtime.gymnasium_games.game_check import SceneReport, check_scene
from tltl_runtime.gymnasium_games.game_file import GameFile, read_game_file
from tltl_runtime.gymnasium_games.space_text import space_json, space_text
from tltl_runtime.gymnasium_games.spec_fit import check_fit
from tltl_runtime.spec.spec_places import SpecPlaces
from tltl_runtime.support.path_text import path_text
from tltlc.api import Diagnostic, Fspa, TltlError, cli

_MOST_SIGNALS: Final = 30
"""A line lists at most this many signals."""

_ANSWERS: Final = {True: "yes", False: "no", None: "unknown, because the game was lost"}


@click.command()
@click.option("--allow-outside", is_flag=True, help="Let the game file name files and specs outside its folder.")
@slow_starts_shown()
def command(
    games: tuple[str, ...],
    inputs: Sequence[cli.Input],
    settings: cli.CompileSettings,
    report: cli.Report,
    allow_outside: bool,
) -> None:
    """Check scenes against the compiled specs ``inputs``; without these, check each against its own spec.

    Scenes that stand for levels are checked as ``--level`` checks them.
    """
    report.facts["scenes"] = []
    for argument in games:
        try:
            chosen = parse_game(argument)
            game = read_game_file(chosen.path, allow_outside=allow_outside)
            check = _GameCheck(game, inputs, settings, report)
            scenes = game.scenes if chosen.scene is None else (scene_of(game, chosen.scene),)
            if game.levels is not None:
                variant = "" if chosen.variant is None else f":{chosen.variant}"
                places = [f"{game.path}:{scene.name}{variant}" for scene in scenes]
                check_levels(places, inputs, settings, report, sensors={})
                continue
            for scene in scenes:
                if chosen.variant is not None:
                    variant_of(game, scene.name, chosen.variant)
                for variant in scene.variants if chosen.variant is None else (chosen.variant,):
                    check(scene.name, variant)
        except TltlError as error:
            report.add(error.diagnostics)


class _GameCheck:
    """Checks the scenes of a game."""

    def __init__(
        self, game: GameFile, inputs: Sequence[cli.Input], settings: cli.CompileSettings, report: cli.Report
    ) -> None:
        self._game, self._inputs, self._settings, self._report = game, inputs, settings, report

    def __call__(self, scene: str, variant: str) -> None:
        """Check one variant of a scene, and report the diagnostics and what the scene offers."""
        try:
            with redirect_stdout(sys.stderr):  # a game may print, and the document goes to standard output
                scene_report = check_scene(self._game, scene, variant)
            specs = [*self._specs(scene, variant)]
        except TltlError as error:
            self._report.add(error.diagnostics)
            return
        self._report.add(scene_report.diagnostics)
        fits: dict[str, list[Diagnostic]] = {}
        for fspa, places in specs:
            fits[fspa.name] = check_fit(scene_report.supply, fspa, places)
            self._report.add(fits[fspa.name])
        for line in _lines(scene_report, fits):
            self._report.say(plain_text(line))  # the names of signals and params are the game's
        self._report.facts["scenes"].append(_facts(self._game, scene_report, fits))

    def _specs(self, scene: str, variant: str) -> Iterator[tuple[Fspa, SpecPlaces]]:
        """Yield each automaton to check the scene against, with the places in its source that diagnostics point to.

        These are the automata of the command's specs; without specs in the command, of the scene's own.
        """
        for opened in self._inputs or self._own_spec(scene, variant):
            specs = {spec.name: spec for spec in opened.program.specs} if opened.program else {}
            for fspa in opened.automata:
                yield fspa, SpecPlaces(specs.get(fspa.name))

    def _own_spec(self, scene: str, variant: str) -> list[cli.Input]:
        spec = variant_of(self._game, scene, variant).spec
        if spec is None:
            advice = 'name one before --game, or in the scene: `spec = "FILE.tltl:NAME"`'
            self._report.say(f"{scene}:{variant}: the scene does not name a spec; {advice}")
            return []
        opened = cli.open_input(path_text(Path(spec.text)), self._settings)
        self._report.add(opened.diagnostics)
        return [opened]


def _lines(scene_report: SceneReport, fits: Mapping[str, Sequence[Diagnostic]]) -> Iterator[str]:
    """Yield the lines that say what a scene offers.

    ``fits`` maps the name of each spec to the diagnostics of its check. The first lines say whether the
    scene fits each spec; without specs, the first line is the name of the scene.
    """
    name, supply = f"{scene_report.scene}:{scene_report.variant}", scene_report.supply
    for spec, diagnostics in fits.items():
        fits_spec = cli.status_of(diagnostics) == cli.CLEAN
        yield f"{name} has the signals that `{spec}` uses" if fits_spec else f"{name} does not fit `{spec}`"
    if not fits:
        yield name
    listed = [*map(str, supply.moments[0].sample)]
    signals = ", ".join(listed[:_MOST_SIGNALS]) + (", …" if len(listed) > _MOST_SIGNALS else "")
    yield f"  signals: {signals or 'none'}"
    yield from _still_lines(scene_report)
    if supply.params:
        yield f"  params: {', '.join(f'{key} = {float(value):g}' for key, value in supply.params.items())}"
    yield f"  observation: {space_text(scene_report.observation)}"
    yield f"  action: {space_text(scene_report.action)}"
    yield f"  capabilities: {', '.join(scene_report.capabilities) or 'none'}"
    for capability, consequence in missing(scene_report.capabilities).items():
        yield f"    no {capability}: {consequence}"
    yield f"  speed: {scene_report.steps_per_s:,.0f} steps a second"
    if scene_report.advice:
        yield f"    {scene_report.advice}"
    yield f"  equal seeds and actions give equal plays: {_ANSWERS[scene_report.reproducible]}"
    if scene_report.restores is not None:
        yield f"  a restored snapshot is what was saved: {_ANSWERS[scene_report.restores]}"
    if scene_report.last_lines:
        yield "  the game's standard error ends:"
        yield from (f"    {line}" for line in scene_report.last_lines)


def _still_lines(scene_report: SceneReport) -> Iterator[str]:
    """Yield a line about the signals that were never true in the play, and one about others that no step changed."""
    moments, steps = scene_report.play.moments, scene_report.play.steps
    if len(scene_report.unchanged) == len(scene_report.supply.moments[0].sample):
        return  # A warning says it.
    false = [
        name
        for name in scene_report.unchanged
        if all(isinstance(value := moment.sample.get(name), (bool, np.bool_)) and not value for moment in moments)
    ]
    constant = [name for name in scene_report.unchanged if name not in false]
    were = "was" if len(false) == 1 else "were"
    for names, what in ((false, f"{were} never true"), (constant, "never changed")):
        if names:
            listed = ", ".join(f"`{name}`" for name in names[:_MOST_SIGNALS])
            more = ", …" if len(names) > _MOST_SIGNALS else ""
            yield f"  in {steps} random steps, {listed}{more} {what}"


def _facts(game: GameFile, scene_report: SceneReport, fits: Mapping[str, Sequence[Diagnostic]]) -> dict[str, Any]:
    """Return the report on a scene as JSON data; ``fits`` maps the name of each spec to its diagnostics."""
    supply = scene_report.supply
    return {
        "game": path_text(game.path),
        "scene": scene_report.scene,
        "variant": scene_report.variant,
        "specs": [
            {"name": spec, "fits": cli.status_of(diagnostics) == cli.CLEAN} for spec, diagnostics in fits.items()
        ],
        "signals": [*map(str, supply.moments[0].sample)],
        "params": None if supply.params is None else {key: float(value) for key, value in supply.params.items()},
        "clock_s": supply.clock_s,
        "observation": space_json(scene_report.observation),
        "action": space_json(scene_report.action),
        "capabilities": list(scene_report.capabilities),
        "missing": missing(scene_report.capabilities),
        "steps_per_s": round(scene_report.steps_per_s, 1),
        "advice": scene_report.advice,
        "unchanged": list(scene_report.unchanged),
        "standard_error": list(scene_report.last_lines),
        "reproducible": scene_report.reproducible,
        "restores": scene_report.restores,
    }
