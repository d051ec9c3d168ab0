"""The targets of the compiler, that is, the formats and languages in which it can write an automaton.

Each target is a module of this package, imported on first use. It has ``TARGET`` (a
:class:`Target`) and a function ``emit(fspa, options) -> Files``, which returns files and writes
nothing to disk. To add a target, add its module. Code that several targets share is in the
subpackages; ``languages`` has the syntax of the languages of monitors.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from types import ModuleType
from typing import Union

from tltlc.automaton.fspa import Fspa, Notation
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

Files = dict[str, Union[str, bytes]]
"""File names (without folders) and their contents."""

DEFAULT_TARGETS = ("json", "dot", "python")


@record
class Target:
    """Describes a target, that is, a format or language that the compiler can write.

    ``name`` is the name of the target and of its module, and ``title`` its description in lists.
    ``endings`` are the endings of the names of its files, such as ``.dot``. ``spell`` converts the name
    of a spec to what comes before the ending. ``known_as`` are other names, in lower case, that people
    may try instead of ``name``: the error then suggests this target.
    """

    name: str
    title: str
    endings: tuple[str, ...]
    known_as: tuple[str, ...] = ()
    spell: Callable[[str], str] = str

    def file_names(self, name: str) -> tuple[str, ...]:
        """Return the names of the files for the spec called ``name``, in the order of ``endings``."""
        return tuple(f"{self.spell(name)}{ending}" for ending in self.endings)


def _ignore(_: Diagnostic) -> None:
    """Do nothing with a diagnostic; this is the default of ``Options.report``."""


@record
class Options:
    """Options of the targets.

    ``notation`` is the notation of formulas in pictures. ``layout_limit_s`` is the most seconds for
    each attempt to lay out a picture. ``report`` is called with a diagnostic if a target has to leave
    something out. ``without_timers`` takes the name of an automaton, and returns the automaton of the
    same spec in which states take the place of timers; it raises TltlError if this is too large. It is
    None if the source text is not known.
    """

    notation: Notation = "unicode"
    layout_limit_s: float = 10.0
    report: Callable[[Diagnostic], None] = _ignore
    without_timers: Callable[[str], Fspa] | None = None


def emit(name: str, fspa: Fspa, options: Options | None = None) -> Files:
    """Return the files that the target called ``name`` writes for an automaton, without writing them to disk.

    Raises:
        TltlError: TLT0710 there is no such target; or an error of the target itself.
        ValueError: the automaton's name is not an ASCII identifier, so it cannot name a file.
    """
    if not (fspa.name.isascii() and fspa.name.isidentifier()):
        raise ValueError(f"{fspa.name!r} is not a plain name")
    files: Files = _module(name).emit(fspa, options or Options())
    return files


def target(name: str) -> Target:
    """Return the description of the target called ``name``; raise TltlError, TLT0710, if there is no such target."""
    target_: Target = _module(name).TARGET
    return target_


def targets() -> tuple[str, ...]:
    """Return the names of all targets, in alphabetical order."""
    import pkgutil

    return tuple(sorted(module.name for module in pkgutil.iter_modules(__path__) if not module.ispkg))


def _module(name: str) -> ModuleType:
    full_name = f"{__name__}.{name}"
    if name.isidentifier():
        try:
            module = importlib.import_module(full_name)
        except ModuleNotFoundError as error:
            if error.name != full_name:
                raise
        else:
            if hasattr(module, "TARGET"):
                return module
    raise TltlError([_unknown_target(name)])


def _unknown_target(name: str) -> Diagnostic:
    from difflib import get_close_matches

    names = targets()
    matches = [candidate for candidate in names if name.lower() in (candidate, *target(candidate).known_as)]
    matches = matches or get_close_matches(name, names, n=1)
    advice = f"did you mean `{matches[0]}`?" if matches else f"there are: {', '.join(names)}"
    return Diagnostic("TLT0710", f"there is no target `{name}`", help=advice)
