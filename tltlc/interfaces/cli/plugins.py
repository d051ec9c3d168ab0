"""Find and load plugins: the entry points of installed packages that extend the command line.

Some belong to other packages, others to parts of tltlc that need optional dependencies.
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
    """An entry point called ``name``: the object ``attribute`` of ``module``, from an installed ``distribution``.

    ``extras`` are the extras (optional dependencies) of the distribution that the object needs.
    """

    name: str
    module: str
    attribute: str
    extras: tuple[str, ...]
    distribution: str


def find(group: str) -> tuple[Plugin, ...]:
    """Return the entry points of a group such as ``tltlc.commands``, without loading them.

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

    If a Python module is not installed, raise TLT0730, whose help says how to install it. The error
    names ``wanted_by``, the command or feature that needs the object.
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

    Raise TLT0730 if no installed package provides the entry point. ``wanted_by`` is as in
    :func:`load`.
    """
    for plugin in find(group):
        if plugin.name == name:
            return load(plugin, wanted_by)
    raise exits.missing_component(wanted_by, "tltl_runtime", "tltlc[game]")


def _plugins_in_folder(group: str, folder: str) -> Iterator[Plugin]:
    """Yield the entry points of a group, from the packages that are installed in a folder of ``sys.path``.

    ``folder`` may also be the path of an archive. The function reads the files ``entry_points.txt``
    in a folder itself, because importing importlib.metadata takes 16 ms.
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
    """Yield the entry points of a group, from the packages in an archive on ``sys.path``, such as a zip file."""
    from importlib.metadata import distributions

    for distribution in distributions(path=[path]):
        text = distribution.read_text("entry_points.txt")
        if text:
            yield from _plugins_in_text(group, text, distribution.metadata["Name"])
