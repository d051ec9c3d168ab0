"""The files of the playground page, and of a static site that runs the compiler in the browser."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Final
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.resolve.imports import standard_library

PAGE: Final = Path(__file__).with_name("page")
PACKAGE: Final = Path(__file__).parents[2]

PYODIDE: Final = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")
"""The files of Pyodide, Python for WebAssembly, that a browser loads."""

_BY_SERVER: Final = 'data-compiler="server"'
_BY_BROWSER: Final = 'data-compiler="browser"'
_EXCLUDED: Final = (
    *(f"interfaces/{name}" for name in ("cli", "lsp")),
    *(f"tools/{name}" for name in ("conformance", "hoa", "mine", "diff", "fmt")),
    *("backends/templates", "stdlib"),
)
"""Parts of the compiler that the page does not use."""
_ENDINGS: Final = (".py", ".json", ".lark", ".md", ".tltl")


def page_files() -> dict[str, bytes]:
    """Return the contents of the playground page's files, by name."""
    return {path.name: path.read_bytes() for path in sorted(PAGE.iterdir()) if path.is_file()}


def site_files(pyodide: Path) -> dict[str, bytes]:
    """Return the contents of the static site's files, by path: the page, the compiler, and Pyodide.

    ``pyodide`` is the folder of the npm package Pyodide, which is Python for WebAssembly.

    Raises TltlError, TLT0730, if that folder lacks a required file.
    """
    missing = [name for name in PYODIDE if not (pyodide / name).is_file()]
    if missing:
        title = f"the site needs Pyodide, but `{pyodide}` does not contain `{missing[0]}`"
        help_ = "run `npm install pyodide`, and name its folder: `--pyodide node_modules/pyodide`"
        raise TltlError([Diagnostic("TLT0730", title, help=help_)])
    files = page_files()
    files["index.html"] = files["index.html"].replace(_BY_SERVER.encode(), _BY_BROWSER.encode())
    files["tltlc.zip"] = _archive()
    files.update({f"pyodide/{name}": (pyodide / name).read_bytes() for name in PYODIDE})
    return files


def _archive() -> bytes:
    """Return a zip file of the compiler's needed parts and the standard library; equal contents give equal bytes."""
    library = standard_library()
    files = {path.relative_to(PACKAGE.parent): path for path in PACKAGE.rglob("*") if _is_needed(path)}
    files.update({Path("tltlc/stdlib", path.name): path for path in library.glob("*.tltl")})
    memory = io.BytesIO()
    with ZipFile(memory, "w") as archive:
        for name, path in sorted(files.items()):
            entry = ZipInfo(name.as_posix())
            entry.compress_type = ZIP_DEFLATED
            archive.writestr(entry, path.read_bytes())
    return memory.getvalue()


def _is_needed(path: Path) -> bool:
    relative = path.relative_to(PACKAGE).as_posix()
    return path.suffix in _ENDINGS and path.is_file() and not any(relative.startswith(f"{part}/") for part in _EXCLUDED)
