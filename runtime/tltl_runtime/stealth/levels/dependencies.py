"""Find the files that a level depends on, and the paths at which they may be."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Final

from tltl_runtime.game.level import parse_level_spec
from tltl_runtime.game.level_files import listed_name
from tltl_runtime.game.level_name import Variant
from tltl_runtime.spec.spec_files import source_of, spec_files, up_to_first_file
from tltl_runtime.stealth.levels.default_spec import LEVELS, SPECS
from tltlc.api import SourceFile, TltlError, fileio

_QUOTED: Final = re.compile(r"\"([^\"\n]+)\"|'([^'\n]+)'")


def level_dependencies(level: Path, variant: Variant) -> Iterator[Path]:
    """Yield the files of the level, the assets and overlays of the variant, and the level's spec.

    Assets are files that levels share; overlays are files with small changes to assets. The files
    may contain errors: if the level's file is not TOML, every quoted text in it counts as a
    possible name. Also yield each path where a new file would be used instead of an existing one.
    """
    yield level
    text = source_of(level)
    table = _table(text)
    if table is None:
        words = [first or second for first, second in _QUOTED.findall(text.text)] if text else []
        assets, overlays, specs = words, words, words
    else:
        asset_names = [use.get("asset") for use in _tables(table.get("use"))]
        asset_names += [enemy.get("kind") for enemy in _tables(table.get("enemy"))]
        variants = table.get("variants")
        variant_overlays = variants.get(variant.name) if isinstance(variants, dict) else None
        assets, specs = _texts(asset_names), _texts([table.get("spec")])
        overlays = _texts(variant_overlays if isinstance(variant_overlays, list) else [])
    places = (level.parent, LEVELS)
    yield from _shared_files(assets, "assets", places, sure=table is not None)
    yield from _shared_files(overlays, "overlays", places, sure=table is not None)
    yield from (Path(name) for name in variant.overlays if name.endswith(".toml"))
    added = [name for name in variant.overlays if not name.endswith(".toml")]
    yield from _shared_files(added, "overlays", places, sure=True)
    for spec in filter(None, map(parse_level_spec, specs)):
        if spec.file.suffix == ".tltl":
            for path in up_to_first_file(folder / spec.file for folder in (level.parent, *SPECS)):
                yield from spec_files(path)


def file_candidates(level: Path, variant: Variant, name: str) -> Iterator[Path]:
    """Yield the paths at which one of a level's files may be.

    ``level`` is the path of the level's own file. ``name`` is the name that the level's field
    ``files`` lists, such as ``assets/guard.toml``. The file may be the level's own file, a file
    beside that or in the package, or an overlay that ``variant`` adds.
    """
    if name == level.name:
        yield level
    yield from (level.parent / name, LEVELS / name)
    for overlay in variant.overlays:
        if overlay.endswith(".toml") and listed_name("overlay", Path(overlay).name) == name:
            yield Path(overlay)


def _shared_files(names: Iterable[str], folder: str, places: Sequence[Path], *, sure: bool) -> Iterator[Path]:
    """Yield the files of the assets or overlays called ``names``.

    ``folder`` is ``assets`` or ``overlays``; ``places`` are the paths that contain such a folder,
    in order of precedence. For each name, yield the paths up to the first file that exists, or all
    paths if none exists. If not ``sure``, a name may mean something else: skip it if no file
    exists.
    """
    for name in names:
        paths = [place / folder / f"{name}.toml" for place in places]
        if sure or any(map(fileio.is_file, paths)):
            yield from up_to_first_file(paths)


def _table(text: SourceFile | None) -> dict[str, Any] | None:
    try:
        return fileio.parse_toml(text, "TLT0801", "") if text else {}
    except TltlError:
        return None


def _tables(value: Any) -> list[dict[str, Any]]:
    return [item for item in value if isinstance(item, dict)] if isinstance(value, list) else []


def _texts(values: Iterable[Any]) -> list[str]:
    return [value for value in values if isinstance(value, str) and value]
