"""What a case depends on: from the files of its level, spec, policy and suite to the cases that a change concerns.

Nothing has to load: of a file with mistakes counts what can be read of it.  A case too many costs minutes and one too
few hides a finding, so that all counts that may matter.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from difflib import get_close_matches
from os.path import normpath
from pathlib import Path
from typing import Any, Final

from tltl_runtime.regression.suite.named_files import policy_file
from tltl_runtime.regression.suite.suite import Case, Suite
from tltl_runtime.stealth.levels.file import level_path
from tltl_runtime.stealth.levels.made_for import LEVELS, SPECS
from tltl_runtime.stealth.levels.place import overlays_of
from tltlc.core.record import record
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Import
from tltlc.io.files import MAX_ARTEFACT_BYTES, exists, is_file, read_source
from tltlc.io.project import FILE_NAME, project_for
from tltlc.io.spec_file import split
from tltlc.io.toml_text import parse as parse_toml
from tltlc.resolve.imports import standard_library

_QUOTED: Final = re.compile(r"\"([^\"\n]+)\"|'([^'\n]+)'")
_ESCAPE: Final = re.compile(rb"\\([0-7]{3}|.)", re.DOTALL)
_LETTERS: Final = {bytes([key]): bytes([meant]) for key, meant in zip(b"abtnvfr", range(7, 14), strict=True)}
_SPEC: Final = re.compile(r"(.+\.tltl)(?::\w+)?\Z")


@record
class Selection:
    """The cases that depend on what is said to have changed, those that do not, and names on which no case depends.

    ``slips`` are those of ``unknown`` that are no file but like one, each with the name that may be meant.
    """

    cases: tuple[Case, ...]
    left_out: tuple[Case, ...] = ()
    unknown: tuple[str, ...] = ()
    slips: tuple[tuple[str, str], ...] = ()


def select(suite: Suite, changed: Sequence[str]) -> Selection:
    r"""The cases that depend on something of ``changed``.

    A name is a file's path or its end (``assets/guard.toml``, ``guard.toml``), either without the ending, too
    (``guard``), or the path of a folder; or one of these as git quotes it (``"assets/w\303\244chter.toml"``).
    """
    of = {case.name: dependencies(suite, case) for case in suite.cases}
    concerned = {case.name for case in suite.cases if any(_is_meant(name, of[case.name]) for name in changed)}
    known = {path for paths in of.values() for path in paths}
    unknown = tuple(name for name in dict.fromkeys(changed) if not _is_meant(name, known))
    # What is named already is no other word for a file that was renamed.
    others = {path for path in known if is_file(path) and not any(_is_meant(name, [path]) for name in changed)}
    meant = ((name, _like(name, others)) for name in unknown)
    return Selection(
        tuple(case for case in suite.cases if case.name in concerned),
        tuple(case for case in suite.cases if case.name not in concerned),
        unknown,
        tuple((name, like) for name, like in meant if like),
    )


def dependencies(suite: Suite, case: Case) -> tuple[Path, ...]:
    """The files that a case depends on, as absolute paths: as they are named, and where links lead.

    Those that would take the place of another one count, too, so that it matters when they are made or deleted.
    """
    found = [suite.path, suite.baseline, policy_file(case.policy)]
    found += _level_files(level_path(case.level), case.variant)
    if case.spec is not None:
        found += _spec_files(Path(split(case.spec)[0]))
    return tuple(dict.fromkeys(each for path in found for each in (Path(normpath(path.absolute())), path.resolve())))


def files_of(suite: Suite) -> frozenset[Path]:
    """The files that a suite's cases depend on, all of which it reads but for the baseline that is recorded."""
    return frozenset(path for case in suite.cases for path in dependencies(suite, case))


def _is_meant(name: str, paths: Iterable[Path]) -> bool:
    given = Path(_unquoted(name))
    place, parts = given.resolve(), given.parts
    return any(
        place == path
        or place in path.parents
        or path.parts[-len(parts) :] == parts
        or any((*path.parts[-len(parts) : -1], bare) == parts for bare in (path.stem, path.name.partition(".")[0]))
        for path in paths
    )


def _like(name: str, paths: Iterable[Path]) -> str | None:
    """What a word that a person wrote may stand for; one with a folder is what git calls a file, deleted perhaps."""
    given = Path(_unquoted(name))
    if len(given.parts) > 1 or exists(given):
        return None
    stems = sorted({path.stem for path in paths if given.suffix in ("", path.suffix)})
    close = get_close_matches(given.stem, stems, n=1, cutoff=0.7)
    return f"{close[0]}{given.suffix}" if close else None


def _unquoted(name: str) -> str:
    """The name that git has quoted, between double quotes with the bytes of other letters in octal; else as it is."""
    if len(name) < 2 or not (name.startswith('"') and name.endswith('"')):
        return name
    parts = _ESCAPE.split(os.fsencode(name[1:-1]))
    # Every second one is what followed a backslash.
    parts[1::2] = [bytes([int(each, 8) % 256]) if each.isdigit() else _LETTERS.get(each, each) for each in parts[1::2]]
    return os.fsdecode(b"".join(parts))


def _level_files(level: Path, variant: str) -> Iterator[Path]:
    """The level, the assets and overlays of the variant, and the spec that it is made for."""
    yield level
    base, added = overlays_of(variant)
    text = _text(level)
    table = _table(text)
    if table is None:
        words = [first or second for first, second in _QUOTED.findall(text.text)] if text else []
        assets, overlays, specs = words, words, words
    else:
        things = [each.get("asset") for each in _tables(table.get("use"))]
        things += [each.get("kind") for each in _tables(table.get("enemy"))]
        named = table.get("variants")
        listed = named.get(base) if isinstance(named, dict) else None
        assets, specs = _texts(things), _texts([table.get("spec")])
        overlays = _texts(listed if isinstance(listed, list) else [])
    places = (level.parent, LEVELS)
    yield from _shared(assets, "assets", places, sure=table is not None)
    yield from _shared(overlays, "overlays", places, sure=table is not None)
    yield from (Path(name) for name in added if name.endswith(".toml"))
    yield from _shared([name for name in added if not name.endswith(".toml")], "overlays", places, sure=True)
    for match in filter(None, map(_SPEC.match, specs)):
        for path in _first(folder / match[1] for folder in (level.parent, *SPECS)):
            yield from _spec_files(path)


def _shared(names: Iterable[str], folder: str, places: Sequence[Path], *, sure: bool) -> Iterator[Path]:
    """The files of assets or overlays; of names that may be something else, the files that there are."""
    for name in names:
        paths = [place / folder / f"{name}.toml" for place in places]
        if sure or any(map(is_file, paths)):
            yield from _first(paths)


def _spec_files(spec: Path) -> Iterator[Path]:
    """A spec's file, what it imports, directly or not, and nothing twice."""
    waiting, seen = [spec], {spec.resolve()}
    while waiting:
        path = waiting.pop()
        yield path
        for imported in _imports(path):
            if imported.resolve() not in seen:
                seen.add(imported.resolve())
                waiting.append(imported)


def _imports(spec: Path) -> Iterator[Path]:
    text = _text(spec)
    if text is None or spec.suffix != ".tltl":
        return
    folder = spec.absolute().parent
    # Where imports are looked for.
    yield from _first(place / FILE_NAME for place in (folder, *folder.parents))
    try:
        libraries = project_for(str(spec)).libraries
    except TltlError:
        libraries = ()
    for declaration in parse(text)[0].declarations:
        if not isinstance(declaration, Import):
            continue
        if declaration.is_path:
            yield spec.parent / declaration.target
        else:
            name = declaration.target.replace(".", "/") + ".tltl"
            yield from _first(folder / name for folder in (spec.parent, *libraries, standard_library()))


def _first(paths: Iterable[Path]) -> Iterator[Path]:
    """The paths up to the first one that is a file: those before it would take its place."""
    for path in paths:
        yield path
        if is_file(path):
            return


def _text(path: Path) -> SourceFile | None:
    try:
        return read_source(path, max_bytes=MAX_ARTEFACT_BYTES)
    except TltlError:
        return None


def _table(text: SourceFile | None) -> dict[str, Any] | None:
    try:
        return parse_toml(text, "TLT0801", "") if text else {}
    except TltlError:
        return None


def _tables(value: Any) -> list[dict[str, Any]]:
    return [each for each in value if isinstance(each, dict)] if isinstance(value, list) else []


def _texts(values: Iterable[Any]) -> list[str]:
    return [value for value in values if isinstance(value, str) and value]
