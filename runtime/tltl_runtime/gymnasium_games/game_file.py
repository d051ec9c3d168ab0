"""Game files: TOML files that describe a game and its scenes.

``docs/games.md`` describes every key. Reading a game file imports and runs nothing that it names.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from tltl_runtime.game.level import LevelSpec, parse_level_spec
from tltl_runtime.game.registry import LEVEL_GAMES, game_named
from tltl_runtime.gymnasium_games.key_names import COMMANDS, NAMES
from tltl_runtime.gymnasium_games.scene_options import read_options
from tltl_runtime.support.checked_table import CheckedTable, wrong_value
from tltl_runtime.support.path_text import path_text
from tltl_runtime.support.suggestion import suggestion
from tltl_runtime.support.toml_tree import Entry, read_tree, value_label
from tltl_runtime.wire.wire_game import PROTOCOLS, START_S, STEP_S, TLTL, WireGame, address
from tltlc.api import EMPTY, Diagnostic, Label, SourceFile, Span, TltlError, fileio, record, replace, specs

SUFFIX: Final = ".game.toml"
FIRST_VARIANT: Final = "v0"
"""The variant of a scene without changes: it has the values of the scene's own table."""

_LEAST_S, _MOST_S = 0.001, 86_400.0
"""The range of the deadlines ``start_s`` and ``step_s``, in seconds."""
_HELP: Final = 'write values as in `clock = "10 Hz"` and `options = { size = 6 }`'
_MODULE: Final = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*\Z", re.ASCII)
_MAKERS: Final = ("gymnasium", "python", "process", "connect", "levels")
"""The keys of ``[game]`` that say how the environment is made. A game file has exactly one of them."""
_OF_PROCESSES: Final = ("protocol", "start_s", "step_s")
"""The keys of ``[game]`` that only games in other processes may have."""
_GAME_KEYS: Final = (*_MAKERS, *_OF_PROCESSES, "import", "signals", "clock", "observation", "keys")
_SCENE_KEYS: Final = ("name", "options", "files", "spec", "variants")


@record
class FunctionName:
    """A Python function: ``function`` in ``module``."""

    module: str
    function: str

    @property
    def text(self) -> str:
        """The function as game files name it: ``MODULE:FUNCTION``."""
        return f"{self.module}:{self.function}"


@record
class SceneVariant:
    """A variant of a scene.

    ``options`` are the keyword arguments with which the environment is made. ``files`` are the files
    that the scene depends on. ``spec`` is the spec that the scene is made for; None if there is
    none. ``label`` is the place of the options in the game file; without options, that of the scene.
    ``option_labels`` are the places of the options.
    """

    options: Mapping[str, Any]
    files: tuple[Path, ...]
    spec: LevelSpec | None
    label: Label
    option_labels: Mapping[str, Label] = EMPTY


@record
class GameScene:
    """A scene of a game, with its variants by name; the first one is ``v0``.

    ``label`` is the place of its name in the game file.
    """

    name: str
    variants: Mapping[str, SceneVariant]
    label: Label


@record
class GameFile:
    """A game, as its file at ``path`` describes it.

    One of four fields says how the environment is made; the others are None. ``gymnasium`` is the id of
    a registered environment, ``python`` a function that returns the environment, and ``wire`` a game in
    another process. ``levels`` is the name of a game of this package: each scene stands for one of its
    levels, and has no variants of its own (:func:`~tltl_runtime.gymnasium_games.level_scenes.level_of_scene`).
    ``modules`` are imported before the environment is made, so that they can register the id.

    ``signals`` is a function from an environment to its signals, or from an observation if the game
    speaks another protocol than ``tltl``; None if the environment has a method ``tltl_signals``.
    ``clock_s`` is the length of a step in seconds; None if the file does not say. ``observation`` are the
    keys of a Dict observation that agents see; empty for all. ``keys`` has a key of the keyboard for each
    action. If it is empty, a person plays with the keys that the environment names, or with the digits.

    ``has_scenes`` is false if the file describes no scene; ``scenes`` then has one that is named after
    the file. ``labels`` are the places of the keys of ``[game]``, and of the table itself as ``game``.
    """

    path: Path
    gymnasium: str | None
    python: FunctionName | None
    wire: WireGame | None
    levels: str | None
    modules: tuple[str, ...]
    signals: FunctionName | None
    clock_s: float | None
    observation: tuple[str, ...]
    keys: tuple[str, ...]
    scenes: tuple[GameScene, ...]
    has_scenes: bool
    labels: Mapping[str, Label]

    @property
    def name(self) -> str:
        """The name of the game: the name of its file without ``.game.toml``."""
        return self.path.name.removesuffix(SUFFIX)

    def scene_for(self, spec: Path, name: str) -> GameScene | None:
        """Return the first scene that is made for the spec called ``name`` in the file ``spec``.

        If there is none, return the only scene of the game, or None if the game has several.
        """
        for scene in self.scenes:
            own = scene.variants[FIRST_VARIANT].spec
            if own is not None and own.file.resolve() == spec.resolve() and own.name in ("", name):
                return scene
        return self.scenes[0] if len(self.scenes) == 1 else None

    @property
    def folder(self) -> Path:
        """The folder of the file: paths in the file are relative to it, and modules are searched in it first."""
        return self.path.parent


@fileio.resource_limits()
def read_game_file(path: Path, *, allow_outside: bool = False) -> GameFile:
    """Read a game file. Paths in it are relative to its folder.

    Unless ``allow_outside``, these paths must lead to files in this folder, or in a folder inside it.

    Raises:
        TltlError: all errors that can be found at once. TLT0001, the file cannot be read; TLT0006,
            too many variants and files; TLT0801, not TOML; TLT0802, an unknown key; TLT0803, a
            missing key, or a value of the wrong kind; TLT0804, two scenes have the same name, or a
            variant has a wrong name; TLT0805, a file does not exist.
    """
    source = fileio.read_source(path, path_text(path), max_bytes=fileio.limits.GAME_FILE.size)
    log: list[Diagnostic] = []
    table = CheckedTable(Entry(read_tree(source, help_=_HELP), Label(source, Span(0, 0))), "the game file", log)
    game = _Reader(path, allow_outside=allow_outside).game(table)
    if log or game is None:
        raise TltlError(log)
    _check_count(game, source)
    return game


class _Reader:
    """Reads the tables of a game file. The methods raise no errors, but add them to the log of the table."""

    def __init__(self, path: Path, *, allow_outside: bool) -> None:
        self._path = path
        self._folder = path.parent
        self._allow_outside = allow_outside

    def game(self, table: CheckedTable) -> GameFile | None:
        """Read the whole file; return None if it has no table ``[game]``."""
        game = table.table("game")
        tables = table.tables("scene")
        scenes = self._scenes(tables, game.label if game else table.label)
        table.report_unknown_keys({**dict.fromkeys(_GAME_KEYS, "[game]"), **dict.fromkeys(_SCENE_KEYS, "[[scene]]")})
        if game is None:
            return None
        if "levels" in game.entries:
            _check_level_keys(game, tables)
            self._check_levels(game, tables)
        _check_makers(game)
        result = GameFile(
            path=self._path,
            gymnasium=game.text("gymnasium", "") or None,
            python=_function(game, "python"),
            wire=self._wire(game),
            levels=game.text("levels", "", one_of=LEVEL_GAMES) or None,
            modules=_modules(game),
            signals=_function(game, "signals"),
            clock_s=_clock_s(game),
            observation=game.names("observation", ()),
            keys=_keys(game),
            scenes=scenes,
            has_scenes="scene" in table.entries,
            labels={"game": game.label, **{key: entry.label for key, entry in game.entries.items()}},
        )
        game.report_unknown_keys(dict.fromkeys(_SCENE_KEYS, "[[scene]]"))
        return result

    def _check_levels(self, game: CheckedTable, scenes: list[CheckedTable]) -> None:
        """Log an error for each scene whose level does not exist."""
        levels = game.entries["levels"].value
        known = game_named(levels).level_files.names() if levels in LEVEL_GAMES else ()
        for scene in [scene for scene in scenes if known and "name" in scene.entries]:
            name = str(scene.entries["name"].value)
            if fileio.is_plain_name(name) and name not in known and not fileio.is_file(self._folder / f"{name}.toml"):
                title = f"there is no level `{name}`: none comes with tltlc, and there is no file `{name}.toml`"
                game.log.append(Diagnostic("TLT0805", title, (scene.label_of("name"),), suggestion(name, known)))

    def _wire(self, game: CheckedTable) -> WireGame | None:
        """Read how a game in another process is started or found.

        Return None if the game runs in this process, or if the keys are wrong.
        """
        process, connect = game.names("process", ()), game.text("connect", "")
        protocol = game.text("protocol", TLTL, one_of=PROTOCOLS)
        start_s = game.number("start_s", START_S, low=_LEAST_S, high=_MOST_S, unit="s")
        step_s = game.number("step_s", STEP_S, low=_LEAST_S, high=_MOST_S, unit="s")
        if "process" in game.entries and not any(process[:1]):
            game.log.append(wrong_value(game.entries["process"], "process", 'a command, e.g. ["godot", "--headless"]'))
        if bool(process) == bool(connect) or (process and not process[0]):
            return None
        try:
            if connect:
                address(connect)
        except TltlError as error:
            game.log += [replace(diagnostic, labels=(game.label_of("connect"),)) for diagnostic in error.diagnostics]
            return None
        if protocol != TLTL and "signals" not in game.entries:
            title = f"a game that speaks `{protocol}` does not say its signals"
            help_ = 'name a function that computes them from an observation: `signals = "MODULE:FUNCTION"`'
            game.log.append(Diagnostic("TLT0803", title, (game.label_of("protocol"),), help_))
        return WireGame(self._path.name, self._folder, process, connect, start_s, step_s, protocol)

    def _scenes(self, tables: list[CheckedTable], around: Label) -> tuple[GameScene, ...]:
        """Read the scenes; if there are none, return one that is named after the file, with the label ``around``."""
        if not tables:
            first = SceneVariant({}, (), None, around)
            return (GameScene(self._path.name.removesuffix(SUFFIX), {FIRST_VARIANT: first}, around),)
        scenes: dict[str, GameScene] = {}
        for table in tables:
            scene = self._scene(table)
            if scene.name and scene.name in scenes:
                title = f"two scenes are called `{scene.name}`"
                table.log.append(Diagnostic("TLT0804", title, (table.label_of("name"),), "rename one of them"))
            scenes[scene.name] = scene
        return tuple(scenes.values())

    def _scene(self, table: CheckedTable) -> GameScene:
        name = table.text("name")
        if name and not fileio.is_plain_name(name):
            table.log.append(wrong_value(table.entries["name"], "name", "a word of letters, digits and `_`"))
        first = self._variant(table, SceneVariant({}, (), None, table.label))
        variants = {FIRST_VARIANT: first}
        named = table.table("variants", needed=False)
        for variant in named.entries if named else ():
            if named is None or (own := named.table(variant)) is None:
                continue
            if variant == FIRST_VARIANT or not fileio.is_plain_name(variant):
                title = f"a variant cannot be called `{variant}`"
                help_ = "give it another word of letters, digits and `_`; `v0` is the scene as it stands"
                table.log.append(Diagnostic("TLT0804", title, (own.label,), help_))
            variants[variant] = self._variant(own, first)
            own.report_unknown_keys()
        table.report_unknown_keys(dict.fromkeys(_GAME_KEYS, "[game]"))
        return GameScene(name, variants, value_label(table.label_of("name")))

    def _variant(self, table: CheckedTable, base: SceneVariant) -> SceneVariant:
        """Read a variant from its table; ``base`` gives the values that the table does not set.

        The table's options replace those of ``base`` with the same name. Its files are added to those of
        ``base``.
        """
        options = table.table("options", needed=False)
        files = [self._inside(table, "files", name) for name in table.names("files", ())]
        return SceneVariant(
            options={**base.options, **(read_options(options) if options else {})},
            files=tuple(dict.fromkeys((*base.files, *(file for file in files if file is not None)))),
            spec=self._spec(table) or base.spec,
            label=table.label_of("options"),
            option_labels={
                **base.option_labels,
                **({key: entry.label for key, entry in options.entries.items()} if options else {}),
            },
        )

    def _spec(self, table: CheckedTable) -> LevelSpec | None:
        spec = parse_level_spec(table.text("spec", ""))
        if spec is None:
            return None
        if not str(spec.file).endswith((".tltl", ".json")) or (spec.name and not fileio.is_plain_name(spec.name)):
            table.log.append(wrong_value(table.entries["spec"], "spec", "FILE.tltl:NAME, e.g. `doorkey.tltl:fetch`"))
            return None
        place = self._inside(table, "spec", str(spec.file))
        return None if place is None else LevelSpec(place, spec.name)

    def _inside(self, table: CheckedTable, key: str, name: str) -> Path | None:
        """Return the path of a file that ``key`` names; log an error and return None if it cannot be used."""
        path = self._folder / name
        try:
            is_inside = self._allow_outside or path.resolve().is_relative_to(self._folder.resolve())
            exists = fileio.is_file(path)
        except (OSError, RuntimeError, ValueError):  # a loop of links, a null character
            is_inside, exists = True, False
        if not is_inside:
            title = f"`{name}` is outside the folder of the game file"
            help_ = "move it into this folder, or the game file into a folder that contains both"
            table.log.append(Diagnostic("TLT0803", title, (table.label_of(key),), help_))
            return None
        if not exists:
            title, help_ = f"there is no file `{name}`", f"paths are relative to the folder of `{self._path.name}`"
            table.log.append(Diagnostic("TLT0805", title, (table.label_of(key),), help_))
            return None
        return path


def _check_makers(game: CheckedTable) -> None:
    """Log an error unless exactly one key says how the environment is made.

    Also log an error for each key that only games in other processes may have, if the game is not one.
    """
    given = [key for key in game.entries if key in _MAKERS]
    if len(given) > 1:
        title = f"`[game]` has both `{given[0]}` and `{given[1]}`"
        game.log.append(Diagnostic("TLT0803", title, (game.label_of(given[1]),), "keep one of them"))
    elif not given:
        title = "`[game]` does not say how the environment is made"
        help_ = 'write `gymnasium = "ID"`, `python = "MODULE:FUNCTION"`, or `process = ["COMMAND", "ARGUMENT"]`'
        game.log.append(Diagnostic("TLT0803", title, (game.label,), help_))
    if not {"process", "connect", "levels"} & game.entries.keys():
        for key in _OF_PROCESSES:
            if key in game.entries:
                title, help_ = f"`{key}` is for games in other processes", "leave it out, or name a `process`"
                game.log.append(Diagnostic("TLT0802", title, (game.label_of(key),), help_))


def _check_level_keys(game: CheckedTable, scenes: list[CheckedTable]) -> None:
    """Log an error for each key that a game of levels cannot have, and if there is no scene."""
    others = [(game, key) for key in game.entries if key in _GAME_KEYS and key not in _MAKERS]
    others += [(scene, key) for scene in scenes for key in scene.entries if key in _SCENE_KEYS and key != "name"]
    for table, key in others:
        title, help_ = f"`{key}` is not for scenes that are levels", "leave it out: the level and its game say it"
        game.log.append(Diagnostic("TLT0802", title, (table.label_of(key),), help_))
    if not scenes:
        title, help_ = "`[game]` has `levels`, but there is no scene", "name a level with `name`, under `[[scene]]`"
        game.log.append(Diagnostic("TLT0803", title, (game.label_of("levels"),), help_))


def _modules(game: CheckedTable) -> tuple[str, ...]:
    modules = game.names("import", ())
    if not all(map(_MODULE.match, modules)):
        game.log.append(wrong_value(game.entries["import"], "import", 'a list of Python modules, e.g. ["minigrid"]'))
    return modules


def _function(table: CheckedTable, key: str) -> FunctionName | None:
    text = table.text(key, "")
    module, _, function = text.partition(":")
    if not text:
        return None
    if not _MODULE.match(module) or not fileio.is_plain_name(function):
        table.log.append(wrong_value(table.entries[key], key, "MODULE:FUNCTION, e.g. `doorkey_signals:signals`"))
        return None
    return FunctionName(module, function)


def _keys(game: CheckedTable) -> tuple[str, ...]:
    """Return the keys of the keyboard; log an error for each that cannot choose an action."""
    keys = game.names("keys", ())
    for number, key in enumerate(keys):
        if key in COMMANDS:
            title, help_ = f"the key `{key}` cannot choose an action: it {COMMANDS[key]}", "name another key"
        elif key not in NAMES:
            title, help_ = f"there is no key `{key}`", suggestion(key, NAMES, 'e.g. "left", "a", "space" and "1"')
        elif key in keys[:number]:
            title, help_ = f"two actions have the key `{key}`", "name another key for one of them"
        else:
            continue
        game.log.append(Diagnostic("TLT0803", title, (game.label_of("keys"),), help_))
    return keys


def _clock_s(table: CheckedTable) -> float | None:
    """Return the seconds of a step; None if the table has no clock, or a wrong one."""
    text = table.text("clock", "")
    clock_s = specs.clock_from_text(text) if text else None
    if text and clock_s is None:
        expected = "a frequency or a period, e.g. `10 Hz` or `0.1 s`"
        table.log.append(wrong_value(table.entries["clock"], "clock", expected))
    return clock_s


def _check_count(game: GameFile, source: SourceFile) -> None:
    """Raise TltlError, TLT0006, if a game has more variants and files than the limit allows."""
    variants = [variant for scene in game.scenes for variant in scene.variants.values()]
    most = fileio.limits.GAME_FILE.values or 0
    if len(variants) + sum(len(variant.files) for variant in variants) > most:
        title = f"`{source.name}` has more than {most:,} variants and files of scenes"
        raise TltlError([Diagnostic("TLT0006", title, (Label(source, Span(0, 0)),), "divide it into several games")])
