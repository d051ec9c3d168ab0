"""The packages outside a game's folder that its game file names: whether their code is still the same."""

from __future__ import annotations

import hashlib
import site
import sys
import sysconfig
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from importlib.metadata import Distribution, PackageNotFoundError, distribution, packages_distributions
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from tltl_runtime.gymnasium_games.game_file import GameFile
from tltl_runtime.gymnasium_games.python_files import content_of, possible_python_files
from tltl_runtime.gymnasium_games.scene_hash import named_modules
from tltl_runtime.support.json_hash import json_hash
from tltlc.api import fileio

_MOST_FILES: Final = 10_000
"""At most this many files of a package are read."""


def installed_code_hash(game: GameFile) -> str:
    """Return the SHA-256, in hexadecimal, of the packages that a game file names; empty if it names none.

    The files of a package of the user count by their contents: those of an editable installation, or of
    any folder of Python's path but ``site-packages``. Files that are not Python count by their sizes and times.
    Other packages count by their versions and by the list of files with which they were installed.
    """
    parts = {package: _fingerprint(package) for package in _packages(game)}
    return json_hash(parts) if parts else ""


def own_package_files(game: GameFile) -> Iterator[Path]:
    """Yield the Python files of the packages of the user that a game file names."""
    for package in _packages(game):
        if not _is_installed(package):
            yield from (path for _, path in _files(package) if path.suffix == ".py")


def _packages(game: GameFile) -> list[str]:
    """Return the packages and modules that a game file names and that are not in its folder."""
    names = dict.fromkeys(module.partition(".")[0] for module in named_modules(game))
    return [
        name
        for name in names
        if name not in sys.stdlib_module_names
        and not any(map(fileio.is_file, possible_python_files(game.folder, [name])))
        and _roots(name)
    ]


def _fingerprint(package: str) -> list[str]:
    if _is_installed(package):
        installed = _distribution(package)
        return [installed.version, _sha256((installed.read_text("RECORD") or "").encode())] if installed else []
    return [f"{path.relative_to(root).as_posix()} {_content_hash(path)}" for root, path in _files(package)]


def _content_hash(path: Path) -> str:
    if path.suffix == ".py":
        return _sha256(content_of(path))
    with suppress(OSError):
        status = path.stat()
        return f"{status.st_size} {status.st_mtime_ns}"
    return ""


def _roots(package: str) -> list[Path]:
    """Return the folders of a package, or the file of a module; nothing runs. Empty if there is none."""
    try:
        spec = find_spec(package)
    except (ImportError, ValueError, AttributeError):
        return []
    if spec is None:
        return []
    if spec.submodule_search_locations:
        return [Path(place).resolve() for place in spec.submodule_search_locations]
    return [Path(spec.origin).resolve()] if spec.origin and Path(spec.origin).is_file() else []


def _files(package: str) -> list[tuple[Path, Path]]:
    """Return the files of a package or of a module, sorted, each after the folder of the package that it is in.

    Hidden files and what Python has compiled are left out. The folder of a module is the one around its file.
    """
    files: list[tuple[Path, Path]] = []
    for root in _roots(package):
        for path in [root] if root.is_file() else root.rglob("*"):
            parts = path.relative_to(root).parts
            if not any(part.startswith((".", "__pycache__")) for part in parts) and path.is_file():
                files.append((root.parent if root.is_file() else root, path))
            if len(files) >= _MOST_FILES:
                break
    return sorted(files)


def _is_installed(package: str) -> bool:
    """Whether a package lies in a folder for installed packages, so that users do not edit it."""
    return any(root.is_relative_to(place) for root in _roots(package) for place in _install_folders())


@cache
def _install_folders() -> tuple[Path, ...]:
    folders = {*site.getsitepackages(), site.getusersitepackages(), *map(sysconfig.get_path, ("purelib", "platlib"))}
    return tuple(Path(folder).resolve() for folder in folders)


def _distribution(package: str) -> Distribution | None:
    for name in (package, *_distribution_names().get(package, ())):
        with suppress(PackageNotFoundError):
            return distribution(name)
    return None


@cache
def _distribution_names() -> dict[str, list[str]]:
    return dict(packages_distributions())


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
