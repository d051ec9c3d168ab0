"""Find the Python files of a game from the imports in their source texts, without running them."""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

from tltl_runtime.support.path_text import path_text
from tltlc.api import Diagnostic, TltlError, fileio

_NAMED_MODULE: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*(?:\.[A-Za-z_][A-Za-z0-9_]*)*(?=:[A-Za-z_]|\Z)")
"""A module in a text, as in ``entry_point="corridor.env:Corridor"``."""


def python_files(folder: Path, modules: Iterable[str]) -> dict[str, bytes]:
    """Return the contents of the Python files in ``folder`` that ``modules`` consist of and import.

    The keys are paths in ``folder``, with slashes. Modules outside the folder are not followed. A
    module counts as imported wherever the import stands, and if a text names it alone or as
    ``MODULE:NAME``. A file that is not valid Python counts, but its imports are unknown.

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
            waiting += [other for module in _imports(contents[name], name) for other in _files_of(folder, module)]
    return dict(sorted(contents.items()))


def content_of(path: Path) -> bytes:
    """Return the bytes of a file; line ends of a text become line feeds, as Git may convert them.

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
    """Yield the files that an import of a module runs: those of its packages, and its own."""
    place = folder
    for part in module.split("."):
        place /= part
        for file in (place / "__init__.py", place.with_suffix(".py")):
            if fileio.is_file(file):
                yield file


def _imports(content: bytes, name: str) -> Iterator[str]:
    """Yield the modules that a file may import; ``name`` is its path in the folder."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(content)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    package = name.split("/")[:-1]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else []
            base = [*above, *(node.module.split(".") if node.module else ())]
            yield from (".".join((*base, alias.name)) for alias in node.names if alias.name != "*")
            yield ".".join(base)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            match = _NAMED_MODULE.match(node.value)
            if match:
                yield match[0]
