"""From the bytes of traces to the evidence: what the atoms are, where they hold, and what contradicts itself."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.resolve.options import ResolveOptions
from tltlc.tools.mine.column_diagnostics import Columns, uneven
from tltlc.tools.mine.columns import columns, shared
from tltlc.tools.mine.evidence import Evidence, Recorded
from tltlc.tools.mine.mutants import with_mutants
from tltlc.tools.mine.reading import Tell, TraceFile, check, read, silent
from tltlc.tools.mine.vocabulary import Words, of_columns, of_library


def gathered(
    good: Sequence[TraceFile],
    bad: Sequence[TraceFile],
    library: SourceFile | None,
    options: ResolveOptions,
    tell: Tell = silent,
) -> tuple[Words, Evidence, tuple[Diagnostic, ...]]:
    """The atoms, the evidence in them, and warnings; without ``bad`` traces counterexamples are made up.

    Raises:
        TltlError: what :func:`~tltlc.tools.mine.vocabulary.of_library`,
        :func:`~tltlc.tools.mine.vocabulary.of_columns` and
            :func:`~tltlc.tools.mine.reading.read` raise; of a trace without columns the reason.
    """
    seen = []
    for file in (*good, *bad):
        tell(f"looking at {file.name}")
        seen.append(Columns(file.name, columns(file.data, file.name)))
        if not seen[-1].columns:
            check(file)
    there = shared([each.columns for each in seen])
    odd = uneven(seen, truths=library is None)
    warnings = tuple(each.warning() for each in odd)
    try:
        words = of_columns(there) if library is None else of_library(library, there, options)
    except TltlError as error:
        # That a trace is unlike the others is the reason, most likely.
        raise TltlError((*warnings, *error.diagnostics)) from None
    said = {name for each in odd for name in each.names}
    rare = dict.fromkeys(name for each in seen for name in each.columns if name not in there)
    words = replace(words, left_out=tuple(name for name in (*words.left_out, *rare) if name not in said))
    traces, notices = read(good, words, tell)
    if not bad:
        return words, with_mutants(traces), (*warnings, *notices)
    counterexamples, more = read(bad, words, tell)
    contradictions = _contradictions(traces, counterexamples)
    return words, Evidence(traces, counterexamples), (*warnings, *notices, *more, *contradictions)


def _contradictions(traces: Sequence[Recorded], counterexamples: Sequence[Recorded]) -> tuple[Diagnostic, ...]:
    """A warning where traces and counterexamples are the same in atoms, with the first of them."""
    known = {trace.letters: trace.name for trace in traces}
    own = {trace.name for trace in traces}
    alike = [each for each in counterexamples if each.letters in known]
    if not alike:
        return ()
    name = alike[0].name
    other = name if name in own else known[alike[0].letters]
    way_out = "move one of them to the other side, or record a signal that tells what differs"
    if len(alike) > 1:
        first = f"`{name}`" if name == other else f"`{name}` as `{other}`"
        title = f"{len(alike)} of {len(counterexamples)} counterexamples are the same in atoms as a trace"
        title += f" ({first}, for one), and no spec tells them apart"
    elif name == other:
        title = f"`{name}` is a trace and a counterexample, and no spec tells the two apart"
    else:
        title = f"`{name}` and `{other}` are the same in atoms, and no spec tells them apart"
    if name == other:
        way_out = "name each trace on one side alone"
    return (Diagnostic("TLT0762", title, help=way_out, severity="warning"),)
