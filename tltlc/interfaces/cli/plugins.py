"""What other distributions, or parts that need an extra, add to the command line through entry points."""

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
    """An entry point: ``attribute`` of ``module``, which needs the ``extras`` of its distribution."""

    name: str
    module: str
    attribute: str
    extras: tuple[str, ...]
    distribution: str


def find(group: str) -> tuple[Plugin, ...]:
    """The entry points of a group, none of them loaded; of distributions of one name, those of the first count."""
    found: dict[tuple[str, str], Plugin] = {}
    first: dict[str, int] = {}
    for index, folder in enumerate(sys.path):
        for plugin in _in_folder(group, folder):
            if first.setdefault(plugin.distribution, index) == index:
                found.setdefault((plugin.distribution, plugin.name), plugin)
    return tuple(found.values())


def load(plugin: Plugin, wanted_by: str) -> Any:
    """What an entry point stands for; error TLT0730, with the way to install it, where it lacks a component."""
    from functools import reduce
    from importlib import import_module

    try:
        return reduce(getattr, plugin.attribute.split("."), import_module(plugin.module))
    except ModuleNotFoundError as error:
        package = plugin.distribution
        wanted = f"{package}[{','.join(plugin.extras)}]" if plugin.extras else error.name or package
        raise exits.missing_component(wanted_by, error.name or package, wanted) from error


def of_levels(name: str, wanted_by: str) -> Any:
    """What knows levels under that name, of the group ``tltlc.levels``; error TLT0730 where it is not installed."""
    for plugin in find("tltlc.levels"):
        if plugin.name == name:
            return load(plugin, wanted_by)
    raise exits.missing_component(wanted_by, "tltl_runtime", "tltlc[game]")


def _in_folder(group: str, folder: str) -> Iterator[Plugin]:
    """The entry points that installed distributions have there: asking importlib.metadata costs 16 ms."""
    try:
        names = os.listdir(folder or ".")  # noqa: PTH208 (no pathlib while only help is asked for)
    except OSError:
        if os.path.isfile(folder):  # noqa: PTH113
            yield from _in_archive(group, folder)
        return
    for name in sorted(names):
        if name.endswith((".dist-info", ".egg-info")):
            try:
                with open(f"{folder or '.'}/{name}/entry_points.txt", encoding="utf-8") as file:  # noqa: PTH123
                    text = file.read()
            except (OSError, UnicodeDecodeError):
                continue
            if f"[{group}]" in text:
                yield from _in_text(group, text, name.rpartition(".")[0].partition("-")[0])


def _in_text(group: str, text: str, distribution: str) -> Iterator[Plugin]:
    section = ""
    for line in map(str.strip, text.splitlines()):
        if line.startswith("["):
            section = line.strip("[]").strip()
        elif section == group and (entry := _ENTRY.fullmatch(line)):
            name, module, attribute, extras = entry.groups()
            yield Plugin(name, module, attribute, tuple(re.findall(r"[\w.-]+", extras or "")), distribution)


def _in_archive(group: str, path: str) -> Iterator[Plugin]:
    """What is inside an archive, only importlib.metadata can say."""
    from importlib.metadata import distributions

    for distribution in distributions(path=[path]):
        text = distribution.read_text("entry_points.txt")
        if text:
            yield from _in_text(group, text, distribution.metadata["Name"])
