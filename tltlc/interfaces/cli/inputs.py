"""Read and compile the argument of a command.

An argument is ``SPEC.tltl``, ``SPEC.tltl:NAME``, an artefact (an automaton that was compiled before,
``NAME.fspa.json``), or ``-`` for standard input.
"""

from __future__ import annotations

from collections.abc import Sequence

import click

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.cli.settings import CompileSettings, check_libraries, compile_settings
from tltlc.interfaces.compiled_input import Input, artefact_error, check_text, compile_input
from tltlc.io.project import GAME_SUFFIX, project_for
from tltlc.io.spec_file import read, split

__all__ = ["Input", "artefact_error", "check_text", "open_input"]


def open_input(argument: str, settings: CompileSettings, specs: Sequence[str] = ()) -> Input:
    """Read and compile an argument, such as ``SPEC.tltl`` or ``SPEC.tltl:NAME``.

    ``specs`` are names of specs to compile; NAME is added to them. Without any name, all specs are
    compiled. If there are errors, raises TltlError with all diagnostics; their severities are those
    that the project file sets. Raises click.UsageError if the argument is a TOML file.
    """
    path, name = split(argument)
    if path.endswith(".toml"):
        message = f"`{path}` is not a spec; if it is a level, check it with `tltlc check --level {path}`"
        if path.endswith(GAME_SUFFIX):
            message = f"`{path}` is not a spec, but a game file; check it with `tltlc check --game {path}`"
        raise click.UsageError(message, click.get_current_context(silent=True))
    spec_names = (*specs, name) if name else tuple(specs)
    check_libraries(settings.libraries)
    project = project_for(path)
    try:
        source, is_artefact = read(path)
    except TltlError as error:
        from tltlc.interfaces.cli.spec_names import with_suggestion

        raise with_suggestion(error, path) from None
    options = compile_settings(settings, project, spec_names)
    return compile_input(source, is_artefact=is_artefact, project=project, options=options)
