"""Levels that are named where something else could be, and levels whose file is gone."""

from __future__ import annotations

import re
from difflib import get_close_matches
from pathlib import Path
from shlex import quote

import click

from tltl_runtime.spec.task import read_spec
from tltl_runtime.stealth.levels.file import level_names, load_level
from tltl_runtime.stealth.levels.place import level_place
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import exists, is_file, read_bytes
from tltlc.io.spec_file import split


def names_level(text: str) -> bool:
    """Whether a text that could be a path is ``LEVEL`` or ``LEVEL:VARIANT`` of a level that comes with the package."""
    return not exists(text) and level_place(text)[0] in level_names()


def check_spelling(text: str) -> None:
    """Raise TltlError, TLT0001, where a name without a folder or a suffix is no path, and nearly that of a level."""
    name = level_place(text)[0]
    close = get_close_matches(name, level_names(), n=1)
    if close and re.fullmatch(r"[\w-]+", name) and not exists(text):
        title = f"there is neither a file nor a level `{text}`"
        raise TltlError([Diagnostic("TLT0001", title, help=f"did you mean the level `{close[0]}`?")])


def check_named(policy: Path | None, level: str | None) -> None:
    """Raise the TltlError that is raised where a policy or a level is read which is not there, before torch is loaded,
    which takes seconds.
    """
    if policy is not None and not names_level(str(policy)) and not exists(policy):
        check_spelling(str(policy))
        read_bytes(policy, str(policy), 0)
    if level is not None:
        name, variant = level_place(level)
        load_level(name, variant or "v0")


def check_no_toml(spec: str | None, settings: str = "") -> None:
    """Raise UsageError where a ``.toml`` stands for a spec: it is a level, or what the option ``settings`` takes."""
    path = split(spec)[0] if spec else ""
    if path.endswith(".toml"):
        ways = [f"where it holds settings, write `{settings} {quote(path)}`"] if settings else []
        ways.append(f"where it is a level, `--level {quote(spec or path)}`")
        raise click.UsageError(f"`{path}` is no spec; {', '.join(ways)}", click.get_current_context())


def check_there(level: str, variant: str, command: str) -> None:
    """Raise TltlError, TLT0001, where a level's file is gone: ``command`` takes it from elsewhere with --level."""
    if level.endswith(".toml") and not exists(level):
        other = "" if variant == "v0" else f":{variant}"
        title = f"the level's file `{level}` is not there any more"
        help_ = f"put it back, or say where it is now: `{command} --level FILE.toml{other}`"
        raise TltlError([Diagnostic("TLT0001", title, help=help_)])


def own_level(spec: str, how: str = "with --level") -> str:
    """The level that a spec is about by its own word: a file beside it, or one that comes with the package.

    ``how`` to name one goes into messages.  Raises UsageError where the spec names none, TltlError where there is none.
    """
    fspa, _ = read_spec(spec)
    if fspa.level is None:
        message = f"`{fspa.name}` does not say which level it is about: name one {how}"
        raise click.UsageError(message, click.get_current_context())
    beside = Path(split(spec)[0]).parent / f"{fspa.level}.toml"
    if is_file(beside):
        return str(beside)
    if fspa.level not in level_names():
        title = f"there is no level `{fspa.level}`: `{beside}` is not there, and none of that name comes with tltlc"
        raise TltlError([Diagnostic("TLT0800", title, help=f"name its file {how}")])
    return fspa.level
