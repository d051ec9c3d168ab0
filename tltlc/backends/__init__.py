"""The targets that an automaton can be written for: one module of this package each, loaded when asked for.

A target is a module with ``TARGET`` (a :class:`Target`) and ``emit(fspa, options) -> Files``, both
pure: nothing is written to disk here.  Adding one means adding that file; what several targets
share lies in the subpackages.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from types import ModuleType
from typing import Literal, Union

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

Files = dict[str, Union[str, bytes]]
"""File names (without folders) and what is to stand in them."""

Notation = Literal["unicode", "ascii", "english"]

DEFAULT_TARGETS = ("json", "dot", "python")


@record
class Target:
    """What a target is: its name (that of its module), a title for listings, how its files' names end.

    ``known_as`` are other words that people look for it by, in lower case.
    """

    name: str
    title: str
    endings: tuple[str, ...]
    known_as: tuple[str, ...] = ()


def _ignore(_: Diagnostic) -> None:
    """Drop a remark."""


@record
class Options:
    """How targets write.

    ``notation`` is that of the formulas in pictures.  ``layout_limit_s`` bounds, in seconds, each
    attempt to lay a picture out.  ``report`` receives a diagnostic when a target had to leave
    something out.
    """

    notation: Notation = "unicode"
    layout_limit_s: float = 10.0
    report: Callable[[Diagnostic], None] = _ignore


def emit(name: str, fspa: Fspa, options: Options | None = None) -> Files:
    """The files of one target.

    Raises:
        TltlError: TLT0710 where there is no such target, and what the target itself raises.
        ValueError: the automaton's name is not plain, so that it cannot name a file.
    """
    if not (fspa.name.isascii() and fspa.name.isidentifier()):
        raise ValueError(f"{fspa.name!r} is no plain name")
    files: Files = _module(name).emit(fspa, options or Options())
    return files


def target(name: str) -> Target:
    """What is known of a target; raises TltlError (TLT0710) where there is none of that name."""
    found: Target = _module(name).TARGET
    return found


def targets() -> tuple[str, ...]:
    """The names of all targets, in alphabetical order."""
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
    raise TltlError([_unknown(name)])


def _unknown(name: str) -> Diagnostic:
    from difflib import get_close_matches

    known = targets()
    near = [each for each in known if name.lower() in (each, *target(each).known_as)]
    near = near or get_close_matches(name, known, n=1)
    way_out = f"did you mean `{near[0]}`?" if near else f"there are: {', '.join(known)}"
    return Diagnostic("TLT0710", f"there is no target `{name}`", help=way_out)
