"""Find, read and parse the files that a module imports, directly or indirectly."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import Final

from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile, SourceKind
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError, replacement_fix
from tltlc.grammar.module import Module
from tltlc.grammar.tree import Import
from tltlc.grammar.typos import likely_name
from tltlc.io.confinement import may_read, outside_diagnostic
from tltlc.io.files import is_file, may_be_file, read_source
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.problem import Log, ResolutionError, problem

_STANDARD_LIBRARY_NAME: Final = "<standard library>"
_NO_FILE: Final = "there is no file `{}` beside this one"


@record
class LoadedModule:
    """A parsed file (``module``), its name in messages (``title``), and its imports.

    ``imports`` pairs each import declaration with the module that it loads.
    """

    module: Module
    title: str
    imports: tuple[tuple[Import, LoadedModule], ...]
    complete: bool
    """Whether this file and all files that it imports, directly or indirectly, were read without error."""


def load(module: Module, options: ResolveOptions, log: Log) -> tuple[LoadedModule, ...]:
    """Return ``module`` and all modules that it imports, directly or indirectly, once each.

    Imported modules come before the modules that import them, so ``module`` is the last. Imports that
    fail are logged and left out.
    """
    done: dict[Path, LoadedModule] = {}
    stack = [_Visit(module, _path_of(module.source), Path(module.source.name).stem)]
    order: list[LoadedModule] = []
    while stack:
        visit = stack[-1]
        declaration = next(visit.pending, None)
        if declaration is None:
            stack.pop()
            loaded = LoadedModule(visit.module, visit.title, tuple(visit.imports), visit.complete)
            order.append(loaded)
            done[visit.path] = loaded
            if stack and visit.declaration:
                stack[-1].add(visit.declaration, loaded)
            continue
        source = visit.module.source
        try:
            path, written = _find(declaration, source, options)
            if path in done:
                visit.add(declaration, done[path])
            elif any(path == ancestor.path for ancestor in stack):
                raise _cycle_error(declaration, source, path, stack)
            else:
                stack.append(_parse(path, written, declaration, source, log))
        except ResolutionError as failure:
            log.add(failure.diagnostic)
            visit.complete = False
    return tuple(order)


def imported_files(source: SourceFile, library_dirs: Iterable[Path] = ()) -> Iterator[Path]:
    """Yield the paths that the import declarations of a source text search.

    For each import, these are the paths in the order of the search, up to the first one with a file.
    So a program that watches them notices a new file that would be imported instead. The files are
    not opened, and the text need not compile.
    """
    for declaration in _parse_once(source)[0].declarations:
        if isinstance(declaration, Import):
            for path in _candidates(declaration, _folder(source), library_dirs):
                yield path
                if is_file(path):
                    break


def standard_library() -> Path:
    """Return the folder of the standard library.

    It is inside the package if tltlc is installed, and next to the package in a checkout.
    """
    package = Path(__file__).parent.parent
    installed = package / "stdlib"
    return installed if installed.is_dir() else package.parent / "stdlib_predicates"


def library_with(name: str) -> str | None:
    """Return the library that declares ``name``: ``"stealth"`` for ``"alive"``; None if there is none.

    Only the libraries of the standard library are searched. Messages suggest to import the result.
    """
    return _names_of_libraries().get(name)


@lru_cache(maxsize=1)
def _names_of_libraries() -> Mapping[str, str]:
    """Map each undotted name that the standard library declares to the library that declares it.

    If several libraries declare a name, the first one in alphabetical order counts. This reads the
    files of all libraries, without their tests, so call it only for messages.
    """
    import re

    declared = re.compile(r"^(?:predicate|signal|param|let)\s+([A-Za-z_][A-Za-z0-9_]*)(?![A-Za-z0-9_.])", re.MULTILINE)
    libraries: dict[str, str] = {}
    for path in _files(standard_library()):
        if not path.stem.endswith("_tests"):
            for match in declared.finditer(_read(path, path).text):
                libraries.setdefault(match[1], path.stem)
    return libraries


class _Visit:
    """A module whose imports are being loaded, and the import declaration that led to it, if any."""

    def __init__(
        self, module: Module, path: Path, title: str, declaration: Import | None = None, complete: bool = True
    ) -> None:
        self.module = module
        self.path = path
        self.title = title
        self.declaration = declaration
        self.complete = complete
        self.imports: list[tuple[Import, LoadedModule]] = []
        self.pending = iter([d for d in module.declarations if isinstance(d, Import)])

    def add(self, declaration: Import, loaded: LoadedModule) -> None:
        """Record the module that an import loads."""
        self.imports.append((declaration, loaded))
        self.complete = self.complete and loaded.complete


def _path_of(source: SourceFile) -> Path:
    try:
        return Path(source.location).absolute()
    except FileNotFoundError:
        return Path(source.location)  # the current folder has been deleted


def _folder(source: SourceFile) -> Path:
    """Return the folder in which the imports of a source text are searched first, as the user wrote its path.

    For a text without a file, this is the current folder.
    """
    if source.kind == "standard library":
        return standard_library()
    return Path(source.location).parent if source.kind == "file" else Path()


def _candidates(declaration: Import, here: Path, library_dirs: Iterable[Path]) -> tuple[Path, ...]:
    """Return the paths at which an imported file may be, in the order of the search.

    ``here`` is the folder of the importing file.
    """
    if declaration.is_path:
        return (here / declaration.target,)
    name = declaration.target.replace(".", "/") + ".tltl"
    return tuple(folder / name for folder in (here, *library_dirs, standard_library()))


def _find(declaration: Import, source: SourceFile, options: ResolveOptions) -> tuple[Path, Path]:
    """Return the path of an imported file twice: absolute, and for messages in the form that the user wrote.

    Raises ResolutionError: TLT0010 if there is no such file, TLT0777 if it may not be read.
    """
    target = declaration.target
    here = _folder(source)
    folders = tuple(
        folder for folder in (here, *options.library_dirs, standard_library()) if not _is_in_deleted_folder(folder)
    )
    candidates = _candidates(declaration, here, options.library_dirs)
    itself = Path(source.name).name
    if declaration.is_path:
        (file,) = candidates
        if _is_in_deleted_folder(file):
            advice = "the current folder has been deleted: start tltlc in another one"
            raise problem("TLT0010", _NO_FILE.format(target), source, declaration.target_span, advice=advice)
        _check_inside(file, declaration, source)
        if not is_file(file):
            file_name = f"{file.name.removesuffix('.tltl')}.tltl"
            suggestion = likely_name(file_name, [path.name for path in _files(file.parent) if path.name != itself])
            unquoted = None if suggestion else _quoted_library(target, folders)
            beginning = target[: target.rfind("/") + 1]
            replacement = f'"{beginning}{suggestion}"' if suggestion else unquoted
            raise problem(
                "TLT0010",
                _NO_FILE.format(target),
                source,
                declaration.target_span,
                advice=_similar_help(suggestion)
                or _quotes_help(unquoted)
                or "a path is relative to the folder of this file",
                fixes=(replacement_fix(source, declaration.target_span, replacement),) if replacement else (),
            )
        return Path(_normalise(file.absolute())), file
    for path in candidates:
        if _is_in_deleted_folder(path):
            continue
        _check_inside(path, declaration, source)
        if is_file(path):
            return Path(_normalise(path.absolute())), path
    known = sorted({path.stem for folder in folders for path in _files(folder) if path.name != itself})
    suggestion = likely_name(target, known)
    advice = _similar_help(suggestion) or "a library is a file NAME.tltl beside this one or in a --library folder"
    title, place = f"there is no library `{target}`", declaration.target_span
    fixes = (replacement_fix(source, place, suggestion),) if suggestion else ()
    raise problem("TLT0010", title, source, place, advice=advice, fixes=fixes)


def _is_in_deleted_folder(path: Path) -> bool:
    """Whether a path is relative and the current folder has been deleted.

    Nothing can be read through such a path.
    """
    if path.is_absolute():
        return False
    try:
        Path.cwd()
    except FileNotFoundError:
        return True
    return False


def _check_inside(path: Path, declaration: Import, source: SourceFile) -> None:
    """Raise ResolutionError (TLT0777) for a path outside the folders that may be read.

    The error is the same whether or not there is a file, so it reveals nothing about files there. A
    path with a NUL byte is accepted here, because it names no file on any system.
    """
    if "\0" not in declaration.target and not may_read(path):
        raise ResolutionError(outside_diagnostic(declaration.target, (Label(source, declaration.target_span),)))


def _similar_help(suggestion: str | None) -> str | None:
    return f"did you mean `{suggestion}`?" if suggestion else None


def _quoted_library(target: str, folders: tuple[Path, ...]) -> str | None:
    """Return the name of the library that the user meant by a quoted path: ``stealth`` for ``import "stealth"``.

    Return None if no folder has a library with this name.
    """
    name = target.removesuffix(".tltl")
    return name if any(is_file(folder / f"{name}.tltl") for folder in folders) and "/" not in name else None


def _quotes_help(library: str | None) -> str | None:
    return f"import a library by its name, without quotes: `import {library}`" if library else None


def _files(folder: Path) -> list[Path]:
    if not may_read(folder):
        return []
    try:
        return sorted(filter(may_be_file, folder.glob("*.tltl")))
    except (OSError, ValueError):
        return []


def _normalise(path: Path) -> str:
    from os.path import normpath

    return normpath(path)


def _read(path: Path, written: Path) -> SourceFile:
    """Read a file. Its name in messages is ``written``, the path as the user wrote it.

    A file of the standard library is named ``<standard library>/core.tltl`` instead, wherever the
    package is installed.
    """
    kind: SourceKind = "standard library"
    try:
        inside = Path(_normalise(written.absolute())).relative_to(standard_library().absolute())
        name = f"{_STANDARD_LIBRARY_NAME}/{inside.as_posix()}"
    except ValueError:
        kind, name = "file", str(written)
    return read_source(path, name, kind=kind)


def _parse(path: Path, written: Path, declaration: Import, source: SourceFile, log: Log) -> _Visit:
    try:
        text = _read(path, written)
    except TltlError as failure:
        here = Label(source, declaration.target_span, "imported here")
        cause = failure.diagnostics[0]
        # TLT0001 is reserved for files named on the command line.
        code = "TLT0010" if cause.code == "TLT0001" else cause.code
        raise ResolutionError(replace(cause, code=code, labels=(*cause.labels, here))) from None
    module, diagnostics = _parse_once(text)
    for diagnostic in diagnostics:
        log.add(diagnostic)
    complete = all(diagnostic.severity != "error" for diagnostic in diagnostics)
    return _Visit(module, path, path.stem, declaration, complete)


@lru_cache(maxsize=64)
def _parse_once(text: SourceFile) -> tuple[Module, tuple[Diagnostic, ...]]:
    """Parse an imported file; the result is cached, since several files may import it."""
    from tltlc.grammar.parser import parse

    return parse(text)


def _cycle_error(declaration: Import, source: SourceFile, path: Path, stack: list[_Visit]) -> ResolutionError:
    start = next(i for i, visit in enumerate(stack) if visit.path == path)
    names = [visit.title for visit in stack[start:]] + [stack[start].title]
    labels = tuple(
        Label(stack[i - 1].module.source, visit.declaration.target_span, f"`{visit.title}` is imported here")
        for i, visit in enumerate(stack)
        if i > start and visit.declaration
    )
    return problem(
        "TLT0011",
        "imports form a cycle: " + " -> ".join(names),
        source,
        declaration.target_span,
        advice="move what both need into a third file",
        related=labels,
    )
