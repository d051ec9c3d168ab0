"""Find the Python files of a game from the imports in their source texts, without running them."""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Final

from tltl_runtime.support.path_text import path_text
from tltlc.api import Diagnostic, TltlError, fileio

_NAMED_MODULE: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*(?:\.[A-Za-z_][A-Za-z0-9_]*)*(?=:[A-Za-z_]|\Z)")
"""A module in a text, as in ``entry_point="corridor.env:Corridor"``."""


def python_files(folder: Path, modules: Iterable[str]) -> dict[str, bytes]:
    """Return the contents of the Python files in ``folder`` that ``modules`` consist of and import.

    The keys are paths relative to ``folder``, with slashes. Modules outside the folder are not followed.
    An import counts wherever it stands in a file. A string that is the name of a module, or
    ``MODULE:NAME``, counts as an import, too, and so does ``import_module(".MODULE", __package__)``.
    ``from PACKAGE import *`` imports the modules in the ``__all__`` of the package. A file that is not
    valid Python is in the result, but its imports are unknown.

    Raises:
        TltlError: TLT0001 or TLT0004, a file cannot be read or is too large.
    """
    contents: dict[str, bytes] = {}
    waiting = [file for module in modules for file in _files_of(folder, module)]
    while waiting:
        file = waiting.pop()
        name = file.relative_to(folder).as_posix()
        if name not in contents:
            contents[name] = content_of(file)
            waiting += [
                other for module in _imports(folder, contents[name], name) for other in _files_of(folder, module)
            ]
    return dict(sorted(contents.items()))


def possible_python_files(folder: Path, modules: Sequence[str]) -> list[Path]:
    """Return the paths in ``folder`` at which the files of ``modules`` and of their imports may be.

    Some of these files may not exist, for example because they were deleted.
    """
    contents = python_files(folder, modules)
    imported = [module for name, data in contents.items() for module in _imports(folder, data, name)]
    places = (path for module in (*modules, *imported) for path in _places_of(folder, module))
    return [*dict.fromkeys([*(folder / name for name in contents), *places])]


def content_of(path: Path) -> bytes:
    """Return the bytes of a file. In a text file, CR LF becomes LF, because Git may convert line ends.

    Raises:
        TltlError: TLT0001 or TLT0004, the file cannot be read or is too large.
    """
    most = fileio.limits.SCENE_FILE.size
    data = fileio.read_bytes(path, path_text(path), most)
    if len(data) > most:
        title = f"`{path_text(path)}` is larger than {most >> 20} MiB"
        raise TltlError([Diagnostic("TLT0004", title, help="a game cannot depend on such a large file: leave it out")])
    return data if b"\0" in data else data.replace(b"\r\n", b"\n")


def _files_of(folder: Path, module: str) -> Iterator[Path]:
    """Yield the files in ``folder`` that an import of a module runs: those of its packages, and its own."""
    return filter(fileio.is_file, _places_of(folder, module))


def _places_of(folder: Path, module: str) -> Iterator[Path]:
    """Yield the paths at which the files of a module may be."""
    place = folder
    # The name is empty for `from . import x` in a module that is in no package.
    for part in filter(None, module.split(".")):
        place /= part
        yield place / "__init__.py"
        yield place.with_suffix(".py")


def _imports(folder: Path, content: bytes, name: str) -> Iterator[str]:
    """Yield the modules that a file may import; ``name`` is its path relative to the game's folder."""
    package = name.split("/")[:-1]
    for node in _nodes(content):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else []
            base = [*above, *(node.module.split(".") if node.module else ())]
            yield from (".".join((*base, alias.name)) for alias in node.names if alias.name != "*")
            yield ".".join(base)
            if any(alias.name == "*" for alias in node.names):
                yield from (".".join((*base, module)) for module in _offered(folder.joinpath(*base, "__init__.py")))
        elif isinstance(node, ast.Call):
            yield from _relative_import(node, package)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            match = _NAMED_MODULE.match(node.value)
            if match:
                yield match[0]


def _nodes(content: bytes) -> Iterator[ast.AST]:
    """Yield all nodes of the syntax tree of a file; none if it is not valid Python."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(content)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    yield from ast.walk(tree)


def _offered(init: Path) -> Iterator[str]:
    """Yield the names in ``__all__`` of a package, whose file is ``init``; none if there is no such file."""
    if not fileio.is_file(init):
        return
    for node in _nodes(content_of(init)):
        if isinstance(node, (ast.Assign, ast.AugAssign, ast.AnnAssign)) and node.value is not None:
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            if any(isinstance(target, ast.Name) and target.id == "__all__" for target in targets):
                yield from filter(str.isidentifier, _strings(node.value))


def _relative_import(call: ast.Call, package: Sequence[str]) -> Iterator[str]:
    """Yield the module of a call ``import_module(".NAME", PACKAGE)``; ``package`` is that of the file."""
    function = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    names = [*_strings(call.args[0])] if call.args else []
    if function != "import_module" or not names or not names[0].startswith("."):
        return
    anchors = [*call.args[1:], *(keyword.value for keyword in call.keywords if keyword.arg == "package")]
    anchor = next((text for node in anchors for text in _strings(node)), None)
    above = package if anchor is None else anchor.split(".")
    module = names[0].lstrip(".")
    kept = len(above) - (len(names[0]) - len(module) - 1)
    yield ".".join((*above[: max(kept, 0)], module))


def _strings(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value
