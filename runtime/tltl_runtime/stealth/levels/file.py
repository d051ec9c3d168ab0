"""Read level files: TOML files written by designers (``docs/levels.md`` describes every key).

A level is a file ``NAME.toml``. Beside it are the folders ``assets/``, with files that levels
share, and ``overlays/``, with files of small changes to assets. An asset or overlay that is missing
there is looked up among the levels that come with the package.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Sequence
from functools import lru_cache
from itertools import chain
from pathlib import Path
from typing import Final

from tltl_runtime.game.level_files import listed_name
from tltl_runtime.game.level_name import Variant, parse_variant
from tltl_runtime.stealth.enemies.grid import is_too_large
from tltl_runtime.stealth.level import Box, EnemyKind, Mover, Region, Solid, StealthLevel, entity_names
from tltl_runtime.stealth.levels import check, level_tables, overlay
from tltl_runtime.stealth.levels.bounds_check import check_room
from tltl_runtime.stealth.levels.default_spec import LEVELS, read_default_spec
from tltl_runtime.stealth.levels.path_check import check_paths
from tltl_runtime.stealth.levels.regions import named_regions, part_regions
from tltl_runtime.support.checked_table import CheckedTable, wrong_value
from tltl_runtime.support.path_text import path_text
from tltl_runtime.support.suggestion import MOST_SUGGESTIONS, suggestion
from tltl_runtime.support.toml_tree import Entry, Tree, read_tree
from tltlc.api import Diagnostic, Label, SourceFile, Span, TltlError, fileio, replace

_MOST_FAULTS: Final = 1_000
"""Stop reading a level after this many faults."""


def level_names() -> tuple[str, ...]:
    """Return the names of the levels that come with the package."""
    return tuple(sorted(path.stem for path in LEVELS.glob("*.toml")))


@fileio.resource_limits()
def variants(name_or_path: str) -> tuple[str, ...]:
    """Return the names of a level's variants, in the order of its file.

    Raises the errors of :func:`load_level`.
    """
    loading = _Loading(level_path(name_or_path))
    loading.check()
    return tuple(loading.variants)


@fileio.resource_limits()
def changes(name_or_path: str, variant: str | Variant) -> tuple[str, ...]:
    """Return the descriptions of a variant's overlays, in the order in which the overlays are applied.

    An overlay is a file with small changes to what the level uses. Raises the errors of
    :func:`load_level`.
    """
    return level_and_changes(name_or_path, variant)[1]


@fileio.resource_limits()
def level_and_changes(name_or_path: str, variant: str | Variant) -> tuple[StealthLevel, tuple[str, ...]]:
    """Return the result of :func:`load_level`, and that of :func:`changes`."""
    loading = _Loading(level_path(name_or_path))
    return loading.level(variant), tuple(loading.changes)


@fileio.resource_limits()
def load_level(name_or_path: str, variant: str | Variant = "v0") -> StealthLevel:
    """Load a shipped level, by name, or one from a ``.toml`` file, in one of its variants.

    An overlay is a file with small changes to what the level uses. ``VARIANT+OVERLAY`` is a variant
    with one more overlay, ``VARIANT+A+B`` with two more. An overlay is given by a name, as in the
    level's list for a variant, or by the path of a ``.toml`` file
    (:func:`~tltl_runtime.game.level_name.parse_variant`).

    :func:`read_level` also returns warnings.

    Raises:
        TltlError: all errors that can be found in one pass. TLT0006, too many things or overlays,
            or bounds that are too large for enemies; TLT0800, unknown level, variant or added
            overlay; TLT0801, a file is not TOML; TLT0802, an unknown key; TLT0803, a missing key,
            or a value of a wrong type or out of range; TLT0804, a name that is taken or that specs
            cannot use; TLT0805, a name that refers to nothing; TLT0806, a thing outside the bounds;
            TLT0807, a thing inside a solid; TLT0808, an overlay changes something that does not
            exist; and the errors of :func:`tltlc.io.files.read_source`.
    """
    return _Loading(level_path(name_or_path)).level(variant)


@fileio.resource_limits()
def read_level(name_or_path: str, variant: str | Variant = "v0") -> tuple[StealthLevel, tuple[Diagnostic, ...]]:
    """Return the result of :func:`load_level`, and warnings about the level.

    A warning, TLT0809, says that the path of a mover (a moving box) or an enemy looks like a
    mistake. Raises the errors of :func:`load_level`.
    """
    loading = _Loading(level_path(name_or_path))
    level = loading.level(variant)
    return level, check_paths(level, loading.places)


def level_path(name_or_path: str) -> Path:
    """Return the path of a level's file. A path that ends in ``.toml`` is returned as it is.

    The file may not exist. Raises TltlError: TLT0800, no shipped level has that name.
    """
    if name_or_path.endswith(".toml"):
        return Path(name_or_path)
    if name_or_path in level_names():
        return LEVELS / f"{name_or_path}.toml"
    title, help_ = f"there is no level `{name_or_path}`", suggestion(name_or_path, level_names())
    if name_or_path.endswith((".tltl", ".json")):
        title = f"`{name_or_path}` is a spec, not a level"
        help_ = "name a `.toml` file, or a level that `tltlc list levels` shows"
    elif "+" in name_or_path and (level := name_or_path.partition("+")[0]) in level_names():
        help_ = f"add overlays to a variant: `{name_or_path.replace(level, f'{level}:v0', 1)}`"
    elif fileio.is_file(f"{name_or_path}.toml"):
        help_ = f"did you mean the file `{name_or_path}.toml`?"
    raise TltlError([Diagnostic("TLT0800", title, help=help_)])


def shared_names(level: Path, folder: str) -> tuple[str, ...]:
    """Return the names, without ``.toml``, of the files in ``folder`` beside a level's file and in the package.

    ``folder`` is ``assets`` or ``overlays``.
    """
    places = (level.parent / folder, LEVELS / folder)
    return tuple(sorted({path.stem for place in places for path in place.glob("*.toml")}))


@lru_cache(maxsize=64)
def _known_tree(source: SourceFile) -> Tree:
    """Parse a TOML file. The result is cached: a run loads levels often, and parsing takes most of the time."""
    return read_tree(source)


class _Loading:
    """The state of loading a level file: the files read so far, and the diagnostics."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.log: list[Diagnostic] = []
        self.files: list[tuple[str, str]] = []
        self.changes: list[str] = []
        self.places = level_tables.NamedParts({}, {}, [])
        self.root = self._read(path, path.name)
        self.table = CheckedTable(self.root, f"the level `{path.stem}`", self.log)
        self.variants = self._variants()

    def level(self, variant: str | Variant) -> StealthLevel:
        """Return the level in a variant. A text, such as ``v0+OVERLAY``, is parsed as in :func:`load_level`.

        Raises the errors of :func:`load_level`.
        """
        if isinstance(variant, str):
            variant = parse_variant(variant)
        if variant.name not in self.variants:
            title = f"the level `{self.path.stem}` has no variant `{variant.name}`"
            label = self.table.label_of("variants")
            raise TltlError([Diagnostic("TLT0800", title, (label,), suggestion(variant.name, self.variants))])
        table, places = self.table, self.places
        doc, spec = table.text("doc"), read_default_spec(table, self.path)
        bounds = self._bounds()
        start = table.table("start")
        uses, assets = self._assets(variant)
        kinds = {
            name: level_tables.enemy_kind(part, name)
            for name, part in assets.items()
            if part.text("type", one_of=("enemy", "part")) == "enemy"
        }
        used_solids, used_movers, used_regions = self._read_parts(uses, assets, kinds)
        switches = level_tables.switches(table, places)
        barriers = level_tables.barriers(table, places)
        exits = level_tables.exits(table, places)
        enemies = level_tables.enemies(table, kinds, places)
        movers = [*used_movers, *level_tables.movers(table, places)]
        solids = [*used_solids, *level_tables.solids(table, places)]
        self._check_count(solids, movers, switches, barriers, exits, enemies)
        if enemies and is_too_large(bounds):
            title = f"the bounds of the level `{self.path.stem}` are too large for enemies"
            help_ = "make them cover at most 250 m by 250 m, or leave out the enemies"
            raise TltlError([Diagnostic("TLT0006", title, (table.label_of("bounds"),), help_)])
        level = StealthLevel(
            name=self.path.stem,
            variant=variant.title,
            doc=doc,
            bounds=bounds,
            start=level_tables.start(start if start is not None else CheckedTable(self.root, "the start", [])),
            solids=(*level_tables.enclosure(bounds), *solids),
            switches=tuple(switches),
            barriers=tuple(barriers),
            unlocks=tuple(level_tables.unlocks(table, places)),
            movers=tuple(movers),
            enemies=tuple(enemies),
            exits=tuple(exits),
            sensors=level_tables.sensors(None, (), places),
            spec=spec,
            files=tuple(self.files),
            signals=self._signals(),
            regions=(*named_regions(table), *used_regions),
        )
        names = entity_names(level)
        level = replace(level, sensors=level_tables.sensors(table.table("sensors", needed=False), names, places))
        table.report_unknown_keys()
        self.check()
        self.log += check.check_names(names, places)
        self.log += check.check_references(level, places)
        self.log += check_room(level, places, table.label_of("start"))
        self.check()
        return level

    def check(self) -> None:
        """Raise a TltlError with all diagnostics logged so far, if there are any."""
        if self.log:
            raise TltlError(self.log)

    def _check_count(self, *groups: Sequence[object]) -> None:
        """Raise TltlError, TLT0006, if the things in ``groups`` are too many for a level.

        Each point of a path or route counts as one more thing. The limit is
        :data:`tltlc.io.limits.LEVEL`.
        """
        points = sum(len(getattr(thing, "path", ())) + len(getattr(thing, "route", ())) for thing in chain(*groups))
        if sum(map(len, groups)) + points > (fileio.limits.LEVEL.values or 0):
            title = f"the level `{self.path.stem}` contains more than {fileio.limits.LEVEL.values:,} things"
            help_ = "leave some out: steps of stairs and points of paths count, too, in each use of a part"
            raise TltlError([Diagnostic("TLT0006", title, (self.root.label,), help_)])

    def _read(self, path: Path, name: str) -> Entry:
        source = fileio.read_source(path, path_text(path))
        # Git may convert line ends; the hash must not depend on that.
        text = source.text.replace("\r\n", "\n")
        self.files.append((name, hashlib.sha256(text.encode()).hexdigest()))
        return Entry(_known_tree(source), Label(source, _first_line(source)))

    def _variants(self) -> dict[str, tuple[str, ...]]:
        """Return the names of the overlays of each variant, by the variant's name.

        A file that lists no variants has only ``v0``, without overlays. Raises a TltlError if the
        list has errors.
        """
        table = self.table.table("variants", needed=False)
        if table is None:
            return {"v0": ()}
        overlays = {key: table.names(key) for key in table.entries}
        if not overlays:
            help_ = "write one, e.g. `v0 = []`, or leave out `[variants]`"
            self.log.append(Diagnostic("TLT0803", "the level has no variants", (table.label,), help_))
        for key in overlays:
            if not fileio.is_plain_name(key):
                title = f"no command can name the variant `{key}`"
                help_ = "use one word of ASCII letters, digits and _ that does not begin with a digit, e.g. `very_hard`"
                self.log.append(Diagnostic("TLT0804", title, (table.label_of(key),), help_))
        self.check()
        return overlays

    def _bounds(self) -> Box:
        table = self.table.table("bounds")
        if table is None:
            return Box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))
        before = len(self.log)
        box = level_tables.box(table)
        table.report_unknown_keys()
        if len(self.log) == before and not box.low[2] < 0.0 < box.high[2]:
            help_ = "the floor is at height 0: `at` must be below it, and `at` and `size` together above it"
            self.log.append(
                Diagnostic("TLT0803", "the bounds do not contain the floor", (table.label_of("at"),), help_)
            )
        return box

    def _assets(self, variant: Variant) -> tuple[list[CheckedTable], dict[str, CheckedTable]]:
        """Return the ``[[use]]`` tables of the level's file, and the assets that it uses, by name.

        An asset is a file that levels share. The overlays that the level lists for the variant, and
        then the added ones, are applied to the assets.
        """
        uses = self.table.tables("use")
        references = [(use, "asset") for use in uses]
        references += [(CheckedTable(enemy, "`[[enemy]]`", []), "kind") for enemy in self._tables_under("enemy")]
        entries: dict[str, Entry] = {}
        for table, key in references:
            name = table.text(key)
            if name and name not in entries and (path := self._find_shared("assets", name, table.label_of(key))):
                entries[name] = self._read(path, listed_name("asset", f"{name}.toml"))
        trees: dict[str, Tree] = {name: entry.value for name, entry in entries.items()}
        names = self.variants[variant.name]
        named = self.table.entries["variants"].value[variant.name].label if names else self.table.label
        overlays = [(name, self._find_shared("overlays", name, named)) for name in names[: fileio.limits.OVERLAYS + 1]]
        overlays += [(name, self._overlay_path(name)) for name in variant.overlays[: fileio.limits.OVERLAYS + 1]]
        if len(overlays) > fileio.limits.OVERLAYS:
            title = f"a variant of the level `{self.path.stem}` has more than {fileio.limits.OVERLAYS} overlays"
            raise TltlError([Diagnostic("TLT0006", title, (named,), "combine their changes in one overlay")])
        for name, path in overlays:
            if path is not None:
                change = self._read(path, listed_name("overlay", path.name))
                self.changes.append(str(change.value["doc"].value) if "doc" in change.value else Path(name).stem)
                trees = overlay.apply(change.value, trees, self.log)
        self.check()
        assets = {
            name: CheckedTable(Entry(tree, entries[name].label), f"the asset `{name}`", self.log)
            for name, tree in trees.items()
        }
        for table in assets.values():
            table.text("doc")
        return uses, assets

    def _tables_under(self, key: str) -> list[Entry]:
        """Return the tables under a key of the level's file, or an empty list."""
        entry = self.root.value.get(key)
        items = entry.value if entry is not None and isinstance(entry.value, list) else []
        return [item for item in items if isinstance(item, Entry)]

    def _overlay_path(self, name: str) -> Path | None:
        """Return the path of an overlay that a caller adds to a variant, by name or by path.

        If there is no overlay of this name, log TLT0800 and return None.
        """
        return Path(name) if name.endswith(".toml") else self._find_shared("overlays", name)

    def _find_shared(self, folder: str, name: str, label: Label | None = None) -> Path | None:
        """Return the path of an asset's or overlay's file, beside the level or in the package.

        ``folder`` is ``assets`` or ``overlays``. If there is no such file, log an error and return
        None. The error is TLT0805 at ``label``, the place where a file names the asset or overlay.
        If ``label`` is None, a caller names it, and the error is TLT0800.
        """
        for place in (self.path.parent / folder, LEVELS / folder):
            if fileio.is_file(path := place / f"{name}.toml") and path.parent == place:
                return path
        known = shared_names(self.path, folder) if len(self.log) < MOST_SUGGESTIONS else ()
        title = f"there is no {folder[:-1]} `{name}`"
        code, labels = ("TLT0805", (label,)) if label else ("TLT0800", ())
        self.log.append(Diagnostic(code, title, labels, suggestion(name, known) if known else None))
        return None

    def _read_parts(
        self, uses: list[CheckedTable], assets: dict[str, CheckedTable], kinds: dict[str, EnemyKind]
    ) -> tuple[list[Solid], list[Mover], list[Region]]:
        """Return the solids, movers and regions of all parts that the level uses.

        A part is a group of solids and movers from an asset, a file that levels share. Each of the
        tables ``uses`` places one part in the level.
        """
        solids: list[Solid] = []
        prefixes: dict[str, CheckedTable] = {}
        movers: list[Mover] = []
        regions: list[Region] = []
        for use in uses:
            asset = use.text("asset")
            prefix, shift = use.text("name", asset) + "_", use.point("at", (0.0, 0.0, 0.0))
            use.report_unknown_keys()
            if prefix in prefixes:
                title, help_ = f"two parts are called `{prefix[:-1]}`", "give one of them another `name`"
                labels = (use.label_of("name"), prefixes[prefix].label_of("name"))
                self.log.append(Diagnostic("TLT0804", title, labels, help_))
                continue
            prefixes[prefix] = use
            if asset in kinds:
                self.log.append(wrong_value(use.entries["asset"], "asset", 'the name of an asset with `type = "part"`'))
                continue
            still = level_tables.solids(assets[asset], self.places, shift, prefix)
            moving = level_tables.movers(assets[asset], self.places, shift, prefix)
            assets[asset].report_unknown_keys()
            solids += still
            movers += moving
            self._check_count(solids, movers)
            # Each use of an asset logs its faults again, so there may be very many.
            if len(self.log) > _MOST_FAULTS:
                self.check()
            regions += part_regions(prefix[:-1], still, moving)
        for enemy in self._tables_under("enemy"):
            kind = enemy.value.get("kind")
            if kind is not None and kind.value in [name for name in assets if name not in kinds]:
                self.log.append(wrong_value(kind, "kind", 'the name of an asset with `type = "enemy"`'))
        return solids, movers, regions

    def _signals(self) -> tuple[tuple[str, str], ...]:
        table = self.table.table("signals", needed=False)
        if table is None:
            return ()
        aliases = tuple((key, table.text(key)) for key in table.entries)
        for key, signal in aliases:
            self.places.refer("signal", table, key, (signal,))
        return aliases


def _first_line(source: SourceFile) -> Span:
    """Return the span of the first line of a file that has content.

    Diagnostics about the whole file point to this line.
    """
    match = re.search(r"^[ \t]*[^#\s].*$", source.text, re.MULTILINE)
    return Span(*match.span()) if match else Span(0, 0)
