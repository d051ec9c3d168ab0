"""Import the Python modules that a game file names.

While a game is made, the folder of its game file comes first in the search for modules. Later, the
folder stays at the end of ``sys.path``, so that modules which the game imports only then are found, too.
"""

from __future__ import annotations

import importlib
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any, Final

from tltl_runtime.gymnasium_games.game_errors import CANNOT_START, guarded
from tltl_runtime.gymnasium_games.game_file import SUFFIX, FunctionName, GameFile
from tltl_runtime.support.suggestion import suggestion
from tltlc.api import Diagnostic, Label, TltlError

_PACKAGES: Final = {"PIL": "pillow", "cv2": "opencv-python", "yaml": "pyyaml", "skimage": "scikit-image"}
"""The names of PyPI packages that differ from the names of their modules, by module."""

_folders: Final[set[Path]] = set()
"""The folders of the games that this process has imported modules from."""


@contextmanager
def folder_first(game: GameFile) -> Iterator[None]:
    """Within this context, search for modules in the folder of a game first.

    First, remove the modules of other games from ``sys.modules``. Otherwise, they would take the place of
    this game's modules with the same names, which would then not register their environments.
    """
    folder = game.folder.resolve()
    own = _top_names(folder)
    # The folders in `_folders` are resolved, so the paths of modules that were found in them are, too.
    others = tuple(f"{other}{os.sep}" for other in _folders if other != folder)
    for name, module in list(sys.modules.items()):
        if not isinstance(module, ModuleType):
            continue
        is_of_another = bool(others) and str(vars(module).get("__file__")).startswith(others)
        is_hidden = name.partition(".")[0] in own and not _is_from(module, folder) and _is_of_a_game(module)
        if (is_of_another and not _is_from(module, folder)) or is_hidden:
            del sys.modules[name]
    _folders.add(folder)
    entry = str(folder)
    sys.path.insert(0, entry)
    importlib.invalidate_caches()
    try:
        yield
    finally:
        sys.path.remove(entry)
        if entry not in sys.path:
            sys.path.append(entry)


def import_module(game: GameFile, name: str, key: str) -> ModuleType:
    """Import a module that the ``key`` of a game file names, within :func:`folder_first`.

    Raises:
        TltlError: TLT0730, a package is not installed; TLT0780, there is no such module, it raises an
            exception, or a module from outside the game's folder has its name.
    """
    label, folder = game.labels[key], game.folder.resolve()
    top = name.partition(".")[0]
    if top in _top_names(folder) and top in sys.modules and not _is_from(sys.modules[top], folder):
        title = f"the game's module `{top}` has the name of another module, which tltlc or Python uses"
        raise TltlError([Diagnostic(CANNOT_START, title, (label,), "give the file another name")])
    with guarded(game, CANNOT_START, f"the module `{name}`", label):
        try:
            return importlib.import_module(name)
        except ModuleNotFoundError as error:
            raise TltlError([_not_found(game, name, error, label)]) from error


def import_function(game: GameFile, name: FunctionName, key: str) -> Callable[..., Any]:
    """Import a function that the ``key`` of a game file names.

    Raises:
        TltlError: the errors of :func:`import_module`; TLT0780, the module has no such function.
    """
    module = import_module(game, name.module, key)
    function = getattr(module, name.function, None)
    if callable(function):
        return function  # type: ignore[no-any-return]
    known = [key for key, value in vars(module).items() if callable(value) and not key.startswith("_")]
    title = f"the module `{name.module}` has no function `{name.function}`"
    raise TltlError([Diagnostic(CANNOT_START, title, (game.labels[key],), suggestion(name.function, known))])


def _not_found(game: GameFile, name: str, error: ModuleNotFoundError, label: Label) -> Diagnostic:
    """Return the diagnostic for ``error``, which importing the module ``name`` has raised.

    Either ``name`` does not exist, or a module that it imports.
    """
    missing = error.name or name
    package = missing.partition(".")[0]
    own = _top_names(game.folder.resolve())
    if package in own:  # the package exists, but not this part of it
        title = f"there is no module `{missing}`"
        return Diagnostic(CANNOT_START, title, (label,), f"look for it in `{package}`, beside the game file")
    title = f"the module `{package}` is not installed, and the game needs it"
    if name != missing and not name.startswith(f"{missing}."):
        title = f"the module `{package}` is not installed, and `{name}` needs it"
    help_ = f"install it: `pip install {_PACKAGES.get(package, package)}`"
    # A name that only begins alike, such as `minigrid_scenes` beside `minigrid`, is another module.
    close = suggestion(package, {module for module in own if not module.startswith(f"{package}_")})
    if close.startswith("did you mean"):
        help_ += f"; or {close}"
    return Diagnostic("TLT0730", title, (label,), help_)


def _top_names(folder: Path) -> set[str]:
    """Return the names of the modules and packages in a folder."""
    try:
        entries = list(folder.iterdir())
    except OSError:
        return set()
    return {
        entry.stem if entry.suffix == ".py" else entry.name
        for entry in entries
        if (entry.suffix == ".py" or (entry.is_dir() and "." not in entry.name and entry.name != "__pycache__"))
    }


def _is_of_a_game(module: ModuleType) -> bool:
    """Whether a game file lies in the folder of a module.

    Then the module belongs to that game, even if this process has not read the game file.
    """
    file = vars(module).get("__file__")
    return file is not None and any(Path(file).parent.glob(f"*{SUFFIX}"))


def _is_from(module: ModuleType, folder: Path) -> bool:
    """Whether a module was imported from a file in a folder."""
    # Do not use `getattr`: some modules create an attribute when it is asked for.
    known = vars(module)
    places = known.get("__path__", ())
    paths = [known.get("__file__"), *(places if isinstance(places, list) else ())]
    return any(path and Path(path).resolve().is_relative_to(folder) for path in paths)
