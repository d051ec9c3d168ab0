"""Build the version of a file that ``tltlc breaking`` compares."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from tltlc.diagnostics.diagnostic import Label
from tltlc.io.files import MAX_ARTEFACT_BYTES, read_source
from tltlc.tools.diff.breaking import Version

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Program


def of_specs(program: Program, automata: tuple[Fspa, ...]) -> Version:
    """Return the version of a compiled source."""
    return Version(automata, {spec.name: Label(spec.source, spec.name_span) for spec in program.specs})


def of_artefact(path: str, automata: tuple[Fspa, ...]) -> Version:
    """Return the version of an artefact; messages point at the name of its spec."""
    from tltlc.artefact.locations import span_of

    source = read_source(path, max_bytes=MAX_ARTEFACT_BYTES)
    place = Label(source, span_of(source.text, ("spec", "name")))
    return Version(automata, {fspa.name: place for fspa in automata})


def of_library(path: str, library_dirs: tuple[Path, ...], params: Mapping[str, str]) -> Version:
    """Return the version of a source that compiles and has no specs."""
    from tltlc.grammar.parser import parse
    from tltlc.resolve.options import ResolveOptions
    from tltlc.resolve.program import resolution
    from tltlc.tools.diff.library import offers
    from tltlc.tools.diff.rules import rules

    module, _ = parse(read_source(path))
    resolved = resolution(module, ResolveOptions(library_dirs=library_dirs, params=params))
    return Version(offers=offers(resolved.env), rules=rules(module, resolved.program))
