"""Read the optional project file ``tltl.toml``, in the folder of a source file or in a folder above it.

All its keys are optional::

    libraries = ["predicates"]           # folders, relative to the project file
    targets = ["json", "dot", "python"]  # what `tltlc compile` writes without -t
    game = "doorkey.game.toml"           # the game that the specs are for, relative to the project file

    [style]
    notation = "unicode"  # of formulas in pictures: unicode, ascii or english
    formatting = "words"  # of what `tltlc fmt` writes: words, letters, symbols or unicode

    [lint]
    allow = ["TLT0419"]  # codes that are not reported
    note = ["TLT0421"]   # codes with another severity; also `warning` and `error`
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache
from os.path import normpath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from tltlc.core.record import EMPTY, record, replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.io.confinement import may_read, outside_diagnostic
from tltlc.io.files import is_dir, is_file, may_be_file, read_source

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Notation

FILE_NAME: Final = "tltl.toml"
GAME_SUFFIX: Final = ".game.toml"
NOTATIONS: Final = ("unicode", "ascii", "english")
FORMATTINGS: Final = ("words", "letters", "symbols", "unicode")
LINT_LEVELS: Final = ("allow", "note", "warning", "error")
_KEYS: Final = ("libraries", "targets", "game", "style", "lint")
_STYLE_KEYS: Final = ("notation", "formatting")


@record
class Project:
    """The settings of a project file.

    ``libraries`` are the folders in which imports are searched. ``targets`` are the formats that
    ``tltlc compile`` writes by default, empty if the file does not set them. ``lint`` maps codes of
    diagnostics, such as ``TLT0419``, to one of the :data:`LINT_LEVELS`. ``notation`` is the
    notation of formulas in pictures, and ``formatting`` the style of ``tltlc fmt``. ``game`` is the
    path of the game file; None if the project names none.
    """

    libraries: tuple[Path, ...] = ()
    targets: tuple[str, ...] = ()
    notation: Notation = "unicode"
    lint: Mapping[str, str] = EMPTY
    formatting: str = "words"
    game: Path | None = None

    def with_lint_levels(self, diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
        """Return the diagnostics with the severities that ``lint`` sets for their codes.

        Diagnostics whose code has the level ``allow`` are left out.
        """
        kept = [diagnostic for diagnostic in diagnostics if self.lint.get(diagnostic.code) != "allow"]
        return tuple(
            replace(diagnostic, severity=self.lint.get(diagnostic.code, diagnostic.severity)) for diagnostic in kept
        )

    @contextmanager
    def apply_lint_levels(self) -> Iterator[None]:
        """If the ``with`` block raises a :class:`TltlError`, apply :meth:`with_lint_levels` to its diagnostics."""
        try:
            yield
        except TltlError as error:
            raise TltlError(self.with_lint_levels(error.diagnostics)) from None


def project_for(path: str) -> Project:
    """Return the settings for a source file, from the nearest project file in its folder or above it.

    For standard input (``-``), the search starts in the current folder. Without a project file, all
    settings have their defaults. If ``path`` is relative, libraries and the game inside the current
    folder get relative paths, too, so that messages show all paths in the same form. Errors are
    those of :func:`read_project`.
    """
    try:
        folder = Path(path).absolute().parent if path != "-" else Path.cwd()
    except FileNotFoundError:
        return Project()  # the current folder has been deleted, so it has no parents
    file = project_file(folder)
    if file is None:
        return Project()
    project = read_project(file)
    if Path(path).is_absolute():
        return project
    game = None if project.game is None else _relative_path(project.game)
    return replace(project, libraries=tuple(map(_relative_path, project.libraries)), game=game)


def project_file(folder: Path) -> Path | None:
    """Return the path of the project file in a folder, or else in the nearest folder above it.

    ``folder`` must be an absolute path. Return None if none of these folders has a project file.
    """
    files = (parent / FILE_NAME for parent in (folder, *folder.parents))
    # A broken link counts, so that reading it reports the problem.
    return next((file for file in files if is_file(file) or (os.path.lexists(file) and may_read(file))), None)


def read_project(path: Path) -> Project:
    """Return the settings in a project file.

    Errors (:class:`TltlError`): those of :func:`tltlc.io.files.read_source`; TLT0001 if ``path`` is
    not a file; TLT0701 if the file is not TOML. If it is TOML, all its errors are raised together:
    TLT0702 for each unknown key; TLT0703 for each wrong value, such as a folder that does not
    exist; TLT0777 for each library or game that :func:`tltlc.io.confinement.confine_reads` forbids
    to read.
    """
    from tltlc.io.toml_text import parse

    if not may_be_file(path):
        title, help_ = f"`{_display_path(path)}` is not a file", "remove it, or give it another name"
        raise TltlError([Diagnostic("TLT0001", title, help=help_)])
    source = read_source(path, _display_path(path))
    table = parse(source, "TLT0701", 'write values as in `targets = ["json", "dot"]`')
    style = table.get("style", {})
    errors = _unknown_keys(table, _KEYS, source)
    if not isinstance(style, dict):
        errors.append(_wrong_value(source, "style", "a table, e.g. `[style]`", style))
        style = {}
    errors += _unknown_keys(style, _STYLE_KEYS, source)
    for key, example in (("libraries", '["predicates"]'), ("targets", '["json", "dot"]')):
        if not _is_list_of_texts(table.get(key, [])):
            errors.append(_wrong_value(source, key, f"a list of texts, e.g. `{key} = {example}`", table.pop(key)))
    notation, formatting = style.get("notation", "unicode"), style.get("formatting", "words")
    for key, value, known in (("notation", notation, NOTATIONS), ("formatting", formatting, FORMATTINGS)):
        if value not in known:
            errors.append(_wrong_value(source, key, "one of " + ", ".join(f'"{word}"' for word in known), value))
    game = _game(table.get("game"), path.parent, source, errors)
    lint = _lint_levels(table.get("lint", {}), source, errors)
    folders = {library: path.parent / library for library in table.get("libraries", [])}
    for library, folder in folders.items():
        if not may_read(folder):
            errors.append(outside_diagnostic(library, _key_labels(source, "libraries")))
        elif not is_dir(folder):
            errors.append(_missing_folder(source, library))
    if errors:
        raise TltlError(errors)
    return Project(tuple(folders.values()), tuple(table.get("targets", [])), notation, lint, formatting, game)


def _unknown_keys(table: dict[str, Any], keys: tuple[str, ...], source: SourceFile) -> list[Diagnostic]:
    """Return an error for each key of a table that is not in ``keys``."""
    from difflib import get_close_matches

    errors = []
    for key in table:
        if key not in keys:
            close_matches = get_close_matches(key, keys, n=1)
            suggestion = (
                f"did you mean `{close_matches[0]}`?"
                if close_matches
                else f"there are: {', '.join(f'`{k}`' for k in keys)}"
            )
            errors.append(Diagnostic("TLT0702", f"unknown key `{key}`", _key_labels(source, key), suggestion))
    return errors


def _game(name: object, folder: Path, source: SourceFile, errors: list[Diagnostic]) -> Path | None:
    """Return the path of the game file ``name``; None if ``name`` is None or not the name of a game file.

    ``name`` is the value of the key ``game``. If it is wrong, or the file does not exist or may not
    be read, append an error to ``errors``.
    """
    if name is None:
        return None
    if not isinstance(name, str) or not name.endswith(GAME_SUFFIX):
        expected = f'the name of a game file, e.g. `game = "doorkey{GAME_SUFFIX}"`'
        errors.append(_wrong_value(source, "game", expected, name))
        return None
    path = folder / name
    if not may_read(path):
        errors.append(outside_diagnostic(name, _key_labels(source, "game")))
    elif not is_file(path):
        title = f"there is no file `{name}` beside this file"
        errors.append(
            Diagnostic("TLT0703", title, _key_labels(source, "game"), "create it, or name a file that exists")
        )
    return path


def _lint_levels(table: object, source: SourceFile, errors: list[Diagnostic]) -> dict[str, str]:
    """Return the level of each code in the table ``lint``: ``{"TLT0419": "allow"}``.

    Append an error to ``errors`` for each key or value that is wrong.
    """
    if not isinstance(table, dict):
        errors.append(_wrong_value(source, "lint", "a table, e.g. `[lint]`", table))
        return {}
    errors += _unknown_keys(table, LINT_LEVELS, source)
    levels: dict[str, str] = {}
    for level in LINT_LEVELS:
        listed = table.get(level, [])
        if not _is_list_of_texts(listed):
            errors.append(_wrong_value(source, level, f'a list of codes, e.g. `{level} = ["TLT0419"]`', listed))
            continue
        for code in listed:
            if not _is_lint_code(code):
                errors.append(_wrong_value(source, level, "codes of `tltlc lint`: TLT04 and two digits", code))
            elif code in levels:
                errors.append(_wrong_value(source, level, f"each code once; `{levels[code]}` has it, too", code))
            levels[code] = level
    return levels


def _is_lint_code(text: str) -> bool:
    """Whether a text is the code of a diagnostic of ``tltlc lint``, such as ``TLT0419``."""
    from tltlc.diagnostics.code_pages import codes

    return text.startswith("TLT04") and text in codes()


def _is_list_of_texts(value: object) -> bool:
    return isinstance(value, list) and all(isinstance(item, str) for item in value)


def _wrong_value(source: SourceFile, key: str, expected: str, value: object) -> Diagnostic:
    kind = f'"{value}"' if isinstance(value, str) else _KINDS.get(type(value).__name__, "another kind of value")
    return Diagnostic("TLT0703", f"wrong value for `{key}`: {kind}", _key_labels(source, key), f"expected {expected}")


def _missing_folder(source: SourceFile, library: str) -> Diagnostic:
    title = f"there is no folder `{library}` beside this file"
    return Diagnostic("TLT0703", title, _key_labels(source, "libraries"), "create it, or name a folder that exists")


_KINDS: Final = {
    "int": "a number",
    "float": "a number",
    "bool": "true or false",
    "list": "a list",
    "dict": "a table",
}


def _key_labels(source: SourceFile, key: str) -> tuple[Label, ...]:
    """Return a tuple with a label at the first line that begins with ``key``.

    The tuple is empty if there is no such line.
    """
    span = _first_words(source.text).get(key)
    return (Label(source, span),) if span else ()


@lru_cache(maxsize=1)
def _first_words(text: str) -> Mapping[str, Span]:
    """Return the words and quoted texts that begin a line, each with its first span at such a place.

    A bracket may stand before the word, as in ``[lint]``.
    """
    import re

    spans: dict[str, Span] = {}
    for match in re.finditer(r"""^[ \t]*\[?[ \t]*(?:"([^"\n]*)"|'([^'\n]*)'|([\w-]+))""", text, re.MULTILINE):
        spans.setdefault(match[match.lastindex or 0], Span(*match.span(match.lastindex or 0)))
    return spans


def _relative_path(path: Path) -> Path:
    return Path(_display_path(Path(normpath(path))))


def _display_path(path: Path) -> str:
    """Return a path as text, relative to the current folder if the path is inside that folder."""
    try:
        return str(path.relative_to(Path.cwd()))
    except ValueError:
        return str(path)
