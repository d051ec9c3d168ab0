"""Compile the spec that the arguments of a tool name, by its path or as a text."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET
from tltlc.automaton.work import STEPS_PER_STATE
from tltlc.core.record import record
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.compiled_input import Input, compile_input
from tltlc.interfaces.mcp.answer import WrongUseError
from tltlc.io.files import is_dir
from tltlc.io.project import Project, project_for
from tltlc.io.spec_file import STDIN, read, split
from tltlc.pipeline import CompileOptions

TEXT_NAME: Final = "<text>"
"""The name, in messages, of a text without a path."""


@record
class SpecArgument:
    """A spec that is read, but not compiled yet.

    ``spec`` is the name of the only spec to compile; None for all specs. ``project`` has the settings
    of the nearest ``tltl.toml``, and ``options`` those of the compiler.
    """

    source: SourceFile
    is_artefact: bool
    spec: str | None
    project: Project
    options: CompileOptions

    def compiled(self) -> Input:
        """Compile the spec. Errors: as for :func:`~tltlc.interfaces.compiled_input.compile_input`."""
        return compile_input(self.source, is_artefact=self.is_artefact, project=self.project, options=self.options)


def read_spec(arguments: Mapping[str, Any], settings: Mapping[str, Any] | None = None) -> SpecArgument:
    """Read the spec that the arguments ``path``, ``text`` and ``spec`` name.

    ``settings`` has the arguments ``params``, ``libraries`` and ``state_budget``; by default, they are
    in ``arguments``, too. Raises WrongUseError if there is neither a path nor a text, or if the path
    names no spec, and TltlError if the file cannot be read.
    """
    path, text, spec = arguments.get("path"), arguments.get("text"), arguments.get("spec")
    if path is None and text is None:
        raise WrongUseError("give `path`, the path of a .tltl file, or `text`, the source text itself")
    if path is not None:
        path, name = split(path)
        if name is not None and spec is not None and name != spec:
            raise WrongUseError(f"`path` names the spec `{name}`, but `spec` names `{spec}`: give one of them")
        spec = name if spec is None else spec
        _check_path(path)
    project = project_for(STDIN if path is None else path)
    source, is_artefact = _source(path, text)
    options = compile_options(arguments if settings is None else settings, project, spec)
    return SpecArgument(source, is_artefact, spec, project, options)


def compile_options(settings: Mapping[str, Any], project: Project, spec: str | None = None) -> CompileOptions:
    """Return the compiler's options, which combine the arguments of a tool and the project file.

    Raises TltlError, TLT0001, for a library folder that does not exist.
    """
    libraries = tuple(map(Path, settings.get("libraries", ())))
    for folder in libraries:
        if not is_dir(folder):
            title = f"there is no library folder `{folder}`"
            raise TltlError([Diagnostic("TLT0001", title, help="name a folder that exists")])
    return CompileOptions(
        library_dirs=(*libraries, *project.libraries),
        params={name: _param_text(value) for name, value in settings.get("params", {}).items()},
        state_budget=settings.get("state_budget", DEFAULT_STATE_BUDGET),
        specs=() if spec is None else (spec,),
    )


def search_work(settings: Mapping[str, Any]) -> int:
    """Return how many steps of work a search in automata may take, for example for a shortest trace."""
    budget: int = settings.get("state_budget", DEFAULT_STATE_BUDGET)
    return STEPS_PER_STATE * budget


def _check_path(path: str) -> None:
    if path == STDIN:
        raise WrongUseError("there is no standard input here: give the source text as `text`")
    if path.endswith(".toml"):
        raise WrongUseError(f"`{path}` is not a spec: name a .tltl file")
    if is_dir(path):
        raise WrongUseError(f"`{path}` is a folder: name a .tltl file in it")


def _source(path: str | None, text: str | None) -> tuple[SourceFile, bool]:
    """Return the source, and whether it is an artefact."""
    if text is None:
        assert path is not None
        return read(path)
    source = SourceFile(TEXT_NAME, text, "text") if path is None else SourceFile(path, text)
    return source, text.lstrip().startswith("{")


def _param_text(value: str | float | bool) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
