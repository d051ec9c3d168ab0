"""Where a spec is declared whose name was given in the place of a file."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.files import exists, is_file, may_be_file, read_source, walk
from tltlc.io.spec_file import is_plain_name

_MOST_FOLDERS: Final = 200
_MOST_FILES: Final = 200
_MOST_NAMED: Final = 3


def with_way_out(error: TltlError, argument: str) -> TltlError:
    """The error for an argument that is no file, which names what was meant: a file, or a spec as ``FILE:NAME``."""
    if exists(argument):
        return error
    if is_file(f"{argument}.tltl"):
        meant = [f"{argument}.tltl"]
    elif is_plain_name(argument):
        meant = [f"{path}:{argument}" for path in islice(_declaring(argument), _MOST_NAMED)]
    else:
        meant = []
    if not meant:
        return error
    way_out = f"did you mean {' or '.join(f'`{each}`' for each in meant)}?"
    return TltlError([replace(each, help=way_out) for each in error.diagnostics])


def _declaring(name: str) -> Iterator[Path]:
    """The files in the current folder and below that declare a spec of that name; of many, some are looked at."""
    from tltlc.grammar.parser import parse
    from tltlc.grammar.tree import SpecDecl

    for path in islice(_files(), _MOST_FILES):
        try:
            source = read_source(path)
        except TltlError:
            continue
        if name in source.text:
            module, _ = parse(source)
            if any(isinstance(each, SpecDecl) and each.name == name for each in module.declarations):
                yield path


def _files() -> Iterator[Path]:
    """Source files, those of the current folder first; hidden ones, pipes and devices are left out."""
    for place, folders, files in islice(walk("."), _MOST_FOLDERS):
        folders[:] = sorted(each for each in folders if not each.startswith("."))
        named = (Path(place, each) for each in sorted(files) if each.endswith(".tltl") and not each.startswith("."))
        yield from filter(may_be_file, named)
