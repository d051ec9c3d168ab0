"""Compile the two versions of each file that ``tltlc breaking`` compares."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tltlc.diagnostics.diagnostic import Label
from tltlc.io.files import MAX_ARTEFACT_BYTES, read_source
from tltlc.tools.diff.breaking import Version

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.pipeline import Session
    from tltlc.resolve.spec import ResolvedFile


def version_of_specs(program: ResolvedFile, automata: tuple[Fspa, ...]) -> Version:
    """Return a source file with specs as a :class:`Version`.

    ``program`` is the resolved file, and ``automata`` are those of its specs.
    """
    return Version(automata, {spec.name: Label(spec.source, spec.name_span) for spec in program.specs})


def version_of_artefact(path: str, automata: tuple[Fspa, ...]) -> Version:
    """Return the spec of an artefact, that is, a compiled spec, as a :class:`Version`.

    Labels for this spec point to its name in the artefact.
    """
    from tltlc.artefact.locations import span_of

    source = read_source(path, max_bytes=MAX_ARTEFACT_BYTES)
    place = Label(source, span_of(source.text, ("spec", "name")))
    return Version(automata, {fspa.name: place for fspa in automata})


def version_of_library(session: Session) -> Version:
    """Return a library, that is, a source without specs, as a :class:`Version`.

    The library must compile without errors.
    """
    from tltlc.tools.diff.library import exports
    from tltlc.tools.diff.library_settings import rules

    return Version(exports=exports(session.resolution.env), rules=rules(session.module, session.program))
