"""Suites: TOML files that list the cases of a regression test.

``docs/regression.md`` describes every key.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from os.path import normpath
from pathlib import Path
from typing import Final

from tltl_runtime.game.level_name import (
    GAME_FILE,
    Variant,
    is_scene,
    level_stem,
    parse_variant,
    split_level,
)
from tltl_runtime.game.registry import game_of
from tltl_runtime.gymnasium_games.level_scenes import level_of_scene
from tltl_runtime.policies.shipped import shipped_policies, shipped_policy
from tltl_runtime.regression.suite.named_files import (
    level_with_fitting_policy,
    policy_diagnostics,
    separate_keys_help,
    similar_level,
    similar_policy,
    spec_diagnostics,
    training_help,
)
from tltl_runtime.regression.suite.thresholds import Thresholds, read_thresholds
from tltl_runtime.regression.suite.trace_case import TraceCase, read_trace_case
from tltl_runtime.support.checked_table import CheckedTable
from tltl_runtime.support.path_text import path_text
from tltl_runtime.support.suggestion import suggestion
from tltl_runtime.support.toml_tree import Entry, read_tree, value_label
from tltlc.api import Diagnostic, Label, Span, TltlError, fileio, record

SHIPPED: Final = Path(__file__).with_name("shipped") / "suite.toml"
"""The suite that comes with the package: three levels, each in three variants."""

LEAST_EPISODES: Final = 25
"""The least number of episodes for a verdict. The paper's Table I uses the same number."""

MOST_EPISODES: Final = 300
"""The most episodes of a case, unless the suite says otherwise."""

_MOST_ERRORS: Final = 100
"""Once a suite has this many errors, no more of its cases are read, because checking a case can take long."""

DEFAULT_ERROR: Final = 0.05
"""The allowed probability of a wrong verdict in a suite that does not set its own ``error``."""

_MAX_EPISODES: Final = 10_000
_CASE_KEYS: Final = ("level", "game", "scene", "variant", "overlay", "reference", "spec", "policy", "traces", "name")
_OF_THRESHOLDS: Final = dict.fromkeys(Thresholds.__match_args__, "[thresholds]")
_HELP: Final = 'write values as in `episodes = 100`, and texts as in `level = "navigation"`'


@record
class Case:
    """A regression test: a policy plays a level in a variant, and a spec judges the episodes.

    ``level`` and ``variant`` name the level, as for
    :meth:`~tltl_runtime.game.game.Game.load_level`. ``reference`` is the variant with whose recorded
    episodes, in the baseline, the case is compared. ``spec`` is ``FILE`` or ``FILE:NAME``, or None for
    the spec that the policy was trained for. ``episodes`` is the greatest number of episodes. ``place``
    is the level's path relative to the suite, which distinguishes levels of the same name; it is
    empty for a level of the package. ``game_file`` is the game file in which a scene stands for the
    level; None if the case names no such scene.
    """

    name: str
    level: str
    variant: Variant
    reference: str
    spec: str | None
    policy: Path
    episodes: int
    thresholds: Thresholds
    place: str = ""
    game_file: Path | None = None

    @property
    def plays_reference(self) -> bool:
        """Whether the case plays the variant that it is compared with."""
        return self.variant == Variant(self.reference)


SuiteCase = Case | TraceCase
"""A case of a suite: a policy plays it, or it has recorded traces."""


@record
class Suite:
    """Regression tests (cases) that are judged together.

    ``path`` is the suite's file. ``seed`` is the seed of the episodes. ``error``, in (0, 1), bounds
    the probability that any certain ``fail`` or ``review`` is wrong, or that any case passes
    although its pass rate is too low. ``baseline`` is the file with the recorded episodes that the
    played cases are compared with.
    """

    path: Path
    seed: int
    error: float
    cases: tuple[SuiteCase, ...]
    baseline: Path

    @property
    def played_cases(self) -> tuple[Case, ...]:
        """The cases that a policy plays."""
        return played(self.cases)


def played(cases: Iterable[SuiteCase]) -> tuple[Case, ...]:
    """Return the cases that a policy plays, without those of recorded traces."""
    return tuple(case for case in cases if isinstance(case, Case))


def baseline_path(suite: Path) -> Path:
    """Return the default path of a suite's baseline: ``folder/a.baseline.json`` for ``folder/a.toml``."""
    return suite.with_name(f"{suite.stem}.baseline.json")


@fileio.resource_limits()
def read_suite(path: Path, baseline: Path | None = None) -> Suite:
    """Read a suite from a file. Paths in the file are relative to it.

    The baseline is ``baseline``, or by default the file at :func:`baseline_path`.

    Raises:
        TltlError: all errors that can be found at once. TLT0801, not TOML; TLT0802, an unknown key;
            TLT0803, a missing key, or a value of the wrong kind or out of range; TLT0804, two cases
            of the same name; TLT0805, a file does not exist; TLT0800, a level or variant does not
            exist; TLT0853, no policy comes with the level; TLT0006, too many cases; and the errors
            of policies and specs from :mod:`~tltl_runtime.regression.suite.named_files`.
    """
    source = fileio.read_source(path, path_text(path))
    log: list[Diagnostic] = []
    table = CheckedTable(Entry(read_tree(source, help_=_HELP), Label(source, Span(0, 0))), "the suite", log)
    if "case" not in table.entries:
        help_ = "a suite lists cases that name levels, each under `[[case]]`"
        if kind := _other_kind_of_file(table):
            raise TltlError([Diagnostic("TLT0803", f"this is {kind}, not a suite", (table.label,), help_)])
        if "level" in table.entries:
            title, help_ = (
                "the suite has no cases, but `level` is a key of a case",
                "write `[[case]]` in a line above it",
            )
            raise TltlError([Diagnostic("TLT0802", title, (table.label_of("level"),), help_)])
    seed = table.whole("seed", 0, low=0, high=2**31 - 1)
    error = table.number("error", DEFAULT_ERROR, low=0.0001, high=0.5, unit="")
    episodes = _episodes(table, MOST_EPISODES)
    thresholds = read_thresholds(table, Thresholds())
    case_tables = table.tables("case")
    if len(case_tables) > (fileio.limits.SUITE.values or 0):
        title, help_ = f"the suite has more than {fileio.limits.SUITE.values:,} cases", "divide it into several suites"
        raise TltlError([Diagnostic("TLT0006", title, (table.label,), help_)])
    known_variants: dict[str, tuple[str, ...]] = {}
    cases: list[tuple[SuiteCase, Label] | None] = []
    for number, case_table in enumerate(case_tables):
        if len(log) >= _MOST_ERRORS:
            log.append(_unread_cases_error(len(case_tables) - number, case_table.label))
            break
        if "traces" in case_table.entries:
            cases.append(read_trace_case(case_table, path.parent, thresholds))
        else:
            cases.append(_case(case_table, path.parent, episodes, thresholds, known_variants))
    table.report_unknown_keys({**dict.fromkeys(_CASE_KEYS, "[[case]]"), **_OF_THRESHOLDS})
    if not cases and not log:
        log.append(Diagnostic("TLT0803", "the suite has no cases", (table.label,), "write one, under `[[case]]`"))
    labels: dict[str, Label] = {}
    for case, label in [labelled_case for labelled_case in cases if labelled_case is not None]:
        if case.name in labels:
            title, help_ = f"two cases are called `{case.name}`", "give one of them another `name`"
            log.append(Diagnostic("TLT0804", title, (label, labels[case.name]), help_))
        labels[case.name] = label
    if log:
        raise TltlError(log)
    return Suite(path, seed, error, tuple(case for case, _ in filter(None, cases)), baseline or baseline_path(path))


def _other_kind_of_file(table: CheckedTable) -> str | None:
    """Guess from the keys of a table from which other kind of file it was read, such as ``a level``.

    None if the kind is unknown.
    """
    kinds = {"an asset": {"type"}, "a level": {"bounds", "start"}, "an overlay": {"change", "add"}}
    return next((kind for kind, keys in kinds.items() if keys & table.entries.keys()), None)


def _unread_cases_error(count: int, label: Label) -> Diagnostic:
    unread = "the last case was not read, because there are too many errors before it"
    if count > 1:
        unread = f"the last {count:,} cases were not read, because there are too many errors before them"
    return Diagnostic("TLT0803", unread, (label,), "correct the errors above, and try again")


def _case(
    table: CheckedTable, folder: Path, episodes: int, thresholds: Thresholds, known_variants: dict[str, tuple[str, ...]]
) -> tuple[Case, Label] | None:
    """Read a played case; return it with the label that shows its place in the file. None if it has errors.

    Errors are added to ``table.log``. ``folder`` is the folder of the suite. ``episodes`` and
    ``thresholds`` are the values for a case that does not set them. ``known_variants`` is the cache
    of :func:`_variants`.
    """
    before = len(table.log)
    level, place = _level(table, folder)
    variant = table.text("variant", "")
    overlays = _overlays(table, folder)
    reference = table.text("reference", "")
    spec = _spec(table, folder)
    episodes, thresholds = _episodes(table, episodes), read_thresholds(table, thresholds)
    name = table.text("name", "")
    policy = _policy(table, folder, level, spec)
    table.report_unknown_keys(_OF_THRESHOLDS)
    if len(table.log) > before or policy is None:
        return None
    variant_names = _variants(table, level, known_variants)
    for key, value in (("variant", variant), ("reference", reference)):
        if value and value not in variant_names:
            title = f"the level `{level}` has no variant `{value}`"
            table.log.append(Diagnostic("TLT0800", title, (table.label_of(key),), suggestion(value, variant_names)))
    overlay_names = game_of(level).level_files.overlays(level)
    for overlay in overlays:
        if not overlay.endswith(".toml") and overlay not in overlay_names:
            title = f"there is no overlay `{overlay}`"
            table.log.append(
                Diagnostic("TLT0805", title, (table.label_of("overlay"),), suggestion(overlay, overlay_names))
            )
    base = variant or variant_names[0]
    name = name or f"{_level_name(level)}:{'+'.join((base, *(Path(overlay).stem for overlay in overlays)))}"
    played = Variant(base, overlays)
    game = folder / table.text("game") if "game" in table.entries and not is_scene(level) else None
    return Case(
        name, level, played, reference or variant_names[0], spec, policy, episodes, thresholds, place, game
    ), table.label


def _level_name(level: str) -> str:
    """Return the name of a level in the name of a case; for a game file without a scene, that of its first scene."""
    if is_scene(level):
        # A game file that cannot be read makes the case fail later.
        with suppress(TltlError):
            return game_of(level).level_files.level_name(level)
    return level_stem(level)


def _variants(table: CheckedTable, level: str, known_variants: dict[str, tuple[str, ...]]) -> tuple[str, ...]:
    """Return the names of the variants of a level, which the case in ``table`` names.

    If the level does not load, the case will fail, but the suite is still valid. For such a level,
    return the variants that the case names, and ``v0``. ``known_variants`` caches the variants by
    level; a level that does not load has an empty tuple there.
    """
    if level not in known_variants:
        try:
            known_variants[level] = game_of(level).level_files.variants(level)
        except TltlError:
            known_variants[level] = ()
    named_variants = (table.entries[key].value for key in ("reference", "variant") if key in table.entries)
    return known_variants[level] or (*named_variants, "v0")


def _level(table: CheckedTable, folder: Path) -> tuple[str, str]:
    """Read the level of a case; return its name or path, and its path relative to the suite.

    The relative path is empty for a level of the package. Both are empty if the case names no level.
    """
    if "game" in table.entries:
        return _scene(table, folder)
    level = table.text("level")
    if not level:
        return "", ""
    if level.endswith(".toml"):
        if not fileio.is_file(folder / level):
            help_ = similar_level(level, folder) or "paths are relative to the suite"
            table.log.append(Diagnostic("TLT0800", f"there is no level `{level}`", (table.label_of("level"),), help_))
        return str(folder / level), Path(normpath(level)).as_posix()
    level_files = game_of(level).level_files
    try:
        level_files.path(level)
    except TltlError as error:
        (diagnostic,) = error.diagnostics
        name, variant = split_level(level)
        exists = name in level_files.names() or fileio.is_file(folder / name)
        help_text = diagnostic.help
        if variant and exists:
            help_text = separate_keys_help(name, parse_variant(variant))
        elif not level.endswith((".tltl", ".json")) and "+" not in level:
            help_text = similar_level(level, folder) or diagnostic.help
        table.log.append(Diagnostic(diagnostic.code, diagnostic.title, (table.label_of("level"),), help_text))
    return level, ""


def _scene(table: CheckedTable, folder: Path) -> tuple[str, str]:
    """Read the keys ``game`` and ``scene`` of a case; return the same pair as :func:`_level`.

    The level is ``FILE.game.toml:SCENE``, without ``:SCENE`` if the case names no scene; or the level that
    this scene stands for.
    """
    file, scene = table.text("game"), table.text("scene", "")
    if not file:
        return "", ""
    if not file.endswith(GAME_FILE):
        title = f"`game` must be the path of a file `NAME{GAME_FILE}`, not `{file}`"
        table.log.append(Diagnostic("TLT0803", title, (table.label_of("game"),), "name the scene with `scene`"))
        return "", ""
    if not fileio.is_file(folder / file):
        table.log.append(_missing_file_error("game", file, table.label_of("game")))
    if ":" in scene:
        name, _, variant = scene.partition(":")
        title, help_ = f"`{scene}` is not the name of a scene", f'write `scene = "{name}"`, `variant = "{variant}"`'
        table.log.append(Diagnostic("TLT0803", title, (table.label_of("scene"),), help_))
    ending = f":{scene}" if scene else ""
    scene_place = f"{folder / file}{ending}"
    level = level_of_scene(scene_place)
    if level == scene_place:
        return level, f"{Path(normpath(file)).as_posix()}{ending}"
    return level, Path(normpath(Path(file).with_name(Path(level).name))).as_posix() if level.endswith(".toml") else ""


def _overlays(table: CheckedTable, folder: Path) -> tuple[str, ...]:
    """Read the overlays (files that change the level) of a case: names, or paths of ``.toml`` files.

    Paths in the suite are relative to ``folder``; the returned paths are relative to the working
    directory.
    """
    entry = table.entries.get("overlay")
    single = entry is not None and not isinstance(entry.value, list)
    names = (table.text("overlay"),) if single else table.names("overlay", ())
    overlays = []
    for name in names:
        path = folder / name
        if name.endswith(".toml") and not fileio.is_file(path):
            table.log.append(_missing_file_error("overlay", name, table.label_of("overlay")))
        overlays.append(str(path) if name.endswith(".toml") else name)
    return tuple(overlays)


def _spec(table: CheckedTable, folder: Path) -> str | None:
    text = table.text("spec", "")
    if not text:
        return None
    file, name = fileio.split_spec_name(text)
    if not fileio.is_file(folder / file):
        table.log.append(_missing_file_error("spec", file, table.label_of("spec")))
    spec = f"{folder / file}:{name}" if name else str(folder / file)
    if fileio.is_file(folder / file):
        table.log += spec_diagnostics(spec, table.label_of("spec"))
    return spec


def _policy(table: CheckedTable, folder: Path, level: str, spec: str | None) -> Path | None:
    """Read the policy of a case; return its path, or None if no policy comes with the level.

    The key ``policy`` is the path of a policy's file, the folder of a training, or the name of a level
    of the package: then it means the policy that comes with that level. By default, it is the policy
    that comes with the case's level. ``spec`` is the one that the case names.
    """
    name = table.text("policy", "")
    if not name or name in shipped_policies():
        shipped = shipped_policy(name or level)
        if shipped is None and level and not table.log:
            title = f"no policy comes with the {'scene' if is_scene(level) else 'level'} `{level}`"
            label = table.label_of("game" if is_scene(level) else "level")
            help_ = f'name a policy that you trained, e.g. `policy = "training/{level_stem(level)}"`'
            if related_level := level_with_fitting_policy(level):
                help_ += f', or the one for the same spec that comes with tltlc: `policy = "{related_level}"`'
            table.log.append(Diagnostic("TLT0853", title, (label,), help_))
        return shipped
    path = folder / name
    if not fileio.exists(path):
        untrained = training_help(name, folder, level, spec) if is_scene(level) else None
        help_ = similar_policy(name, folder, untrained)
        label = value_label(table.label_of("policy"))
        table.log.append(Diagnostic("TLT0805", f"there is no policy `{name}`", (label,), help_))
    else:
        table.log += policy_diagnostics(path, table.label_of("policy"))
    return path


def _episodes(table: CheckedTable, default: int) -> int:
    return table.whole("episodes", default, low=LEAST_EPISODES, high=_MAX_EPISODES)


def _missing_file_error(kind: str, name: str, label: Label) -> Diagnostic:
    return Diagnostic(
        "TLT0805", f"there is no {kind} `{name}`", (value_label(label),), "paths are relative to the suite"
    )
