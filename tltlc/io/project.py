"""The optional project file ``tltl.toml``, found upwards from a source file.

libraries = ["predicates"]            # folders, relative to the project file
targets = ["json", "dot", "python"]   # what `tltlc compile` writes without -t

[style]
notation = "unicode"                  # of formulas in pictures: unicode, ascii or english
formatting = "words"                  # of what `tltlc fmt` writes: words, letters, symbols or unicode

[lint]
allow = ["TLT0419"]                   # what nothing is said of; note, warning and error change a severity
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
from tltlc.io.files import is_dir, is_file, may_be_file, may_read, outside, read_source

if TYPE_CHECKING:
    from tltlc.backends import Notation

FILE_NAME: Final = "tltl.toml"
NOTATIONS: Final = ("unicode", "ascii", "english")
FORMATTINGS: Final = ("words", "letters", "symbols", "unicode")
LINT_LEVELS: Final = ("allow", "note", "warning", "error")
_KEYS: Final = ("libraries", "targets", "style", "lint")
_STYLE_KEYS: Final = ("notation", "formatting")


@record
class Project:
    """What a project file says; ``targets`` is empty where it says nothing of them.

    ``lint`` maps codes to one of :data:`LINT_LEVELS`.
    """

    libraries: tuple[Path, ...] = ()
    targets: tuple[str, ...] = ()
    notation: Notation = "unicode"
    lint: Mapping[str, str] = EMPTY
    formatting: str = "words"

    def levelled(self, found: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
        """What the compiler says, with the severities of ``lint``, less what that allows."""
        left = [each for each in found if self.lint.get(each.code) != "allow"]
        return tuple(replace(each, severity=self.lint.get(each.code, each.severity)) for each in left)

    @contextmanager
    def levelling(self) -> Iterator[None]:
        """Within it, what a :class:`TltlError` says beside its errors is :meth:`levelled`, too."""
        try:
            yield
        except TltlError as error:
            raise TltlError(self.levelled(error.diagnostics)) from None


def project_for(path: str) -> Project:
    """The project that a source file belongs to, by the nearest project file in its folder or above.

    For standard input that is the current folder.  Libraries inside the current folder are named from there, unless
    the file's own path is absolute: as in messages on the file.  Errors: those of :func:`read_project`.
    """
    try:
        folder = Path(path).absolute().parent if path != "-" else Path.cwd()
    except FileNotFoundError:
        return Project()  # the current folder has been deleted: nothing is above it
    file = project_file(folder)
    if file is None:
        return Project()
    project = read_project(file)
    libraries = project.libraries if Path(path).is_absolute() else map(_from_here, project.libraries)
    return replace(project, libraries=tuple(libraries))


def project_file(folder: Path) -> Path | None:
    """The nearest project file in an absolute folder or above it; None where there is none."""
    files = (place / FILE_NAME for place in (folder, *folder.parents))
    # A link that leads nowhere counts: whoever reads it reports it.
    return next((file for file in files if is_file(file) or (os.path.lexists(file) and may_read(file))), None)


def read_project(path: Path) -> Project:
    """The contents of a project file.

    Errors: TLT0701 no TOML; else everything that is wrong: TLT0702 an unknown key, TLT0703 a value of the wrong kind,
    TLT0777 a library that :func:`tltlc.io.files.confined` forbids.
    """
    from tltlc.io.toml_text import parse

    if not may_be_file(path):
        title, help_ = f"`{_shown(path)}` is no file", "remove it, or give it another name"
        raise TltlError([Diagnostic("TLT0001", title, help=help_)])
    source = read_source(path, _shown(path))
    table = parse(source, "TLT0701", 'values are written as in `targets = ["json", "dot"]`')
    style = table.get("style", {})
    wrong = _unknown(table, _KEYS, source)
    if not isinstance(style, dict):
        wrong.append(_wrong(source, "style", "a table, e.g. `[style]`", style))
        style = {}
    wrong += _unknown(style, _STYLE_KEYS, source)
    for key, example in (("libraries", '["predicates"]'), ("targets", '["json", "dot"]')):
        if not _is_list_of_texts(table.get(key, [])):
            wrong.append(_wrong(source, key, f"a list of texts, e.g. `{key} = {example}`", table.pop(key)))
    notation, formatting = style.get("notation", "unicode"), style.get("formatting", "words")
    for key, value, known in (("notation", notation, NOTATIONS), ("formatting", formatting, FORMATTINGS)):
        if value not in known:
            wrong.append(_wrong(source, key, "one of " + ", ".join(f'"{word}"' for word in known), value))
    lint = _lint(table.get("lint", {}), source, wrong)
    folders = {library: path.parent / library for library in table.get("libraries", [])}
    for library, folder in folders.items():
        if not may_read(folder):
            wrong.append(outside(library, _place(source, "libraries")))
        elif not is_dir(folder):
            wrong.append(_no_folder(source, library))
    if wrong:
        raise TltlError(wrong)
    return Project(tuple(folders.values()), tuple(table.get("targets", [])), notation, lint, formatting)


def _unknown(table: dict[str, Any], keys: tuple[str, ...], source: SourceFile) -> list[Diagnostic]:
    """An error for each key that a table cannot have."""
    from difflib import get_close_matches

    found = []
    for key in table:
        if key not in keys:
            close = get_close_matches(key, keys, n=1)
            way_out = f"did you mean `{close[0]}`?" if close else f"there are: {', '.join(f'`{k}`' for k in keys)}"
            found.append(Diagnostic("TLT0702", f"unknown key `{key}`", _place(source, key), way_out))
    return found


def _lint(table: object, source: SourceFile, wrong: list[Diagnostic]) -> dict[str, str]:
    """The level of each code that the table ``lint`` names; what is wrong with it joins the rest."""
    if not isinstance(table, dict):
        wrong.append(_wrong(source, "lint", "a table, e.g. `[lint]`", table))
        return {}
    wrong += _unknown(table, LINT_LEVELS, source)
    found: dict[str, str] = {}
    for level in LINT_LEVELS:
        listed = table.get(level, [])
        if not _is_list_of_texts(listed):
            wrong.append(_wrong(source, level, f'a list of codes, e.g. `{level} = ["TLT0419"]`', listed))
            continue
        for code in listed:
            if not _is_code(code):
                wrong.append(_wrong(source, level, "codes that `tltlc lint` has, TLT04 and two digits", code))
            elif code in found:
                wrong.append(_wrong(source, level, f"each code once; `{found[code]}` has it, too", code))
            found[code] = level
    return found


def _is_code(text: str) -> bool:
    """Whether it is the code of a remark."""
    from tltlc.diagnostics.codes import codes

    return text.startswith("TLT04") and text in codes()


def _is_list_of_texts(value: object) -> bool:
    return isinstance(value, list) and all(isinstance(item, str) for item in value)


def _wrong(source: SourceFile, key: str, expected: str, found: object) -> Diagnostic:
    shown = f'"{found}"' if isinstance(found, str) else _KINDS.get(type(found).__name__, "another kind of value")
    return Diagnostic("TLT0703", f"wrong value for `{key}`: {shown}", _place(source, key), f"expected {expected}")


def _no_folder(source: SourceFile, library: str) -> Diagnostic:
    title = f"there is no folder `{library}` beside this file"
    return Diagnostic("TLT0703", title, _place(source, "libraries"), "create it, or name one that is there")


_KINDS: Final = {
    "int": "a number",
    "float": "a number",
    "bool": "true or false",
    "list": "a list",
    "dict": "a table",
}


def _place(source: SourceFile, key: str) -> tuple[Label, ...]:
    """Where the key stands first at the start of a line, as far as that can be told."""
    span = _first_words(source.text).get(key)
    return (Label(source, span),) if span else ()


@lru_cache(maxsize=1)
def _first_words(text: str) -> Mapping[str, Span]:
    """The first place of each word, or text in quotes, with which a line begins, perhaps behind a bracket."""
    import re

    found: dict[str, Span] = {}
    for match in re.finditer(r"""^[ \t]*\[?[ \t]*(?:"([^"\n]*)"|'([^'\n]*)'|([\w-]+))""", text, re.MULTILINE):
        found.setdefault(match[match.lastindex or 0], Span(*match.span(match.lastindex or 0)))
    return found


def _from_here(library: Path) -> Path:
    return Path(_shown(Path(normpath(library))))


def _shown(path: Path) -> str:
    """The path, relative to the current folder where it lies inside."""
    try:
        return str(path.relative_to(Path.cwd()))
    except ValueError:
        return str(path)
