"""``tltlc new --game``: a small game for an engine, with the client, a level, a spec, a suite and a CI file.

Each kind of game is a folder of ``tltl_runtime/starter/games``. Its files are written as they are; those of the
folder ``common`` are added, unless the kind has a file of the same name. Two things about names: the suffix
``.template`` is removed, which keeps tools for Python from taking the file for a module of tltlc, and ``dot_`` at
the start of a name stands for a dot.

A kind's ``starter.toml`` is not written. Its key ``clients`` lists the paths that copies of clients get: the name of
each is that of a file of ``tltl_runtime/wire/clients``. Its key ``steps`` lists the commands to go on with;
without it, they are :data:`STEPS`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

from tltl_runtime.support.checked_table import CheckedTable
from tltl_runtime.support.suggestion import suggestion
from tltl_runtime.support.toml_tree import Entry, read_tree
from tltlc.api import Diagnostic, Label, Span, TltlError, fileio

_PACKAGE: Final = Path(__file__).parents[2]
KINDS: Final = _PACKAGE / "starter" / "games"
"""The folder with a folder for each kind."""
_CLIENTS: Final = _PACKAGE / "wire" / "clients"
_COMMON: Final = "common"
_ABOUT: Final = "starter.toml"
_SUFFIX: Final = ".template"
_DOT: Final = "dot_"

STEPS: Final = (
    "tltlc check --game hall.game.toml",
    "tltlc train --game hall.game.toml:hall --config settings.toml --out agent",
    "tltlc baseline suite.toml",
    "tltlc regress suite.toml",
)
"""The commands that follow, inside the new folder, unless a kind has others."""


def kinds() -> tuple[str, ...]:
    """Return the kinds of games that there are starters for, in alphabetical order; each client of theirs exists."""
    names = sorted(path.parent.name for path in KINDS.glob(f"*/{_ABOUT}"))
    return tuple(name for name in names if all(map(Path.is_file, _clients(_about(KINDS / name / _ABOUT)[0]))))


def files(kind: str) -> tuple[dict[str, str], tuple[str, ...]]:
    """Return the texts of all files of a starter, by their paths, and the commands that follow in its folder.

    Raises:
        TltlError: TLT0700, there is no such kind.
    """
    if kind not in kinds():
        title = f"there is no starter for games of the kind `{kind}`"
        raise TltlError([Diagnostic("TLT0700", title, help=suggestion(kind, kinds()))])
    clients, steps = _about(KINDS / kind / _ABOUT)
    texts = {**_texts(KINDS / _COMMON), **_texts(KINDS / kind)}
    texts |= {path: _text(client) for path, client in zip(clients, _clients(clients), strict=True)}
    return texts, steps


def _clients(paths: Iterable[str]) -> list[Path]:
    """Return the file of tltlc of which each of the ``paths`` in the new folder is a copy."""
    return [_CLIENTS / Path(path).name for path in paths]


def _about(path: Path) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the paths of the clients in the new folder, and the commands that follow."""
    source = fileio.read_source(path, path.name)
    log: list[Diagnostic] = []
    table = CheckedTable(Entry(read_tree(source), Label(source, Span(0, 0))), path.name, log)
    clients, steps = table.names("clients"), table.names("steps", STEPS)
    table.report_unknown_keys()
    if log:
        raise TltlError(log)
    return clients, steps


def _texts(folder: Path) -> dict[str, str]:
    """Return the texts of the files below a folder, by the paths that the new files have."""
    return {_new_name(path.relative_to(folder)): _text(path) for path in _below(folder) if path.name != _ABOUT}


def _below(folder: Path) -> Iterator[Path]:
    for path in sorted(folder.iterdir()):
        if path.is_dir():
            yield from _below(path)
        else:
            yield path


def _new_name(path: Path) -> str:
    names = [f".{name.removeprefix(_DOT)}" if name.startswith(_DOT) else name for name in path.parts]
    return "/".join(names).removesuffix(_SUFFIX)


def _text(path: Path) -> str:
    return fileio.read_source(path, path.name).text
