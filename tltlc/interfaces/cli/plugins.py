"""Find and load plugins: the entry points that extend the command line.

They belong to other installed packages, or to parts of tltlc that need optional dependencies.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from typing import Any, Final

from tltlc.core.record import record
from tltlc.interfaces.cli import exits

_ENTRY: Final = re.compile(r"([^=\s]+)\s*=\s*([\w.]+)\s*:\s*([\w.]+)\s*(?:\[(.*)\])?")


@record
class Plugin:
    """An entry point: ``attribute`` of ``module``, which an installed ``distribution`` provides.

    ``extras`` are the extras (optional dependencies) that it needs.
    """

    name: str
    module: str
    attribute: str
    extras: tuple[str, ...]
    distribution: str


def find(group: str) -> tuple[Plugin, ...]:
    """Return the entry points of a group, without loading them.

    If a distribution is installed several times, only the first copy on ``sys.path`` counts.
    """
    entries: dict[tuple[str, str], Plugin] = {}
    first_folders: dict[str, int] = {}
    for index, folder in enumerate(sys.path):
        for plugin in _plugins_in_folder(group, folder):
            if first_folders.setdefault(plugin.distribution, index) == index:
                entries.setdefault((plugin.distribution, plugin.name), plugin)
    return tuple(entries.values())


def load(plugin: Plugin, wanted_by: str) -> Any:
    """Import the object that an entry point names.

    If a Python module is not installed, raise TLT0730 with help for its installation. ``wanted_by``
    is the name, in the message, of the command or feature that needs the object.
    """
    from functools import reduce
    from importlib import import_module

    try:
        return reduce(getattr, plugin.attribute.split("."), import_module(plugin.module))
    except ModuleNotFoundError as error:
        package = plugin.distribution
        requirement = f"{package}[{','.join(plugin.extras)}]" if plugin.extras else error.name or package
        raise exits.missing_component(wanted_by, error.name or package, requirement) from error


def load_from(group: str, name: str, wanted_by: str) -> Any:
    """Load the object of the entry point ``name`` in a group of the runtime, such as ``tltlc.levels``.

    Raise TLT0730 if no installed package provides it. ``wanted_by`` is as in :func:`load`.
    """
    for plugin in find(group):
        if plugin.name == name:
            return load(plugin, wanted_by)
    raise exits.missing_component(wanted_by, "tltl_runtime", "tltlc[game]")


def _plugins_in_folder(group: str, folder: str) -> Iterator[Plugin]:
    """Yield the entry points of a group, from the packages that are installed in a folder.

    Does not use importlib.metadata, whose import takes 16 ms.
    """
    try:
        names = os.listdir(folder or ".")  # noqa: PTH208 (no pathlib while only help is asked for)
    except OSError:
        if os.path.isfile(folder):  # noqa: PTH113
            yield from _plugins_in_archive(group, folder)
        return
    for name in sorted(names):
        if name.endswith((".dist-info", ".egg-info")):
            try:
                with open(f"{folder or '.'}/{name}/entry_points.txt", encoding="utf-8") as file:  # noqa: PTH123
                    text = file.read()
            except (OSError, UnicodeDecodeError):
                continue
            if f"[{group}]" in text:
                yield from _plugins_in_text(group, text, name.rpartition(".")[0].partition("-")[0])


def _plugins_in_text(group: str, text: str, distribution: str) -> Iterator[Plugin]:
    section = ""
    for line in map(str.strip, text.splitlines()):
        if line.startswith("["):
            section = line.strip("[]").strip()
        elif section == group and (entry := _ENTRY.fullmatch(line)):
            name, module, attribute, extras = entry.groups()
            yield Plugin(name, module, attribute, tuple(re.findall(r"[\w.-]+", extras or "")), distribution)


def _plugins_in_archive(group: str, path: str) -> Iterator[Plugin]:
    """Yield the entry points of a group, from an archive, which only importlib.metadata can read."""
    from importlib.metadata import distributions

    for distribution in distributions(path=[path]):
        text = distribution.read_text("entry_points.txt")
        if text:
            yield from _plugins_in_text(group, text, distribution.metadata["Name"])
