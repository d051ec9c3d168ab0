"""Read trace files into evidence: find the atoms and where they hold, and report contradictions."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.resolve.options import ResolveOptions
from tltlc.tools.mine.column_diagnostics import Columns, uneven
from tltlc.tools.mine.columns import columns, shared
from tltlc.tools.mine.evidence import Evidence, LabelledTrace
from tltlc.tools.mine.mutants import with_mutants
from tltlc.tools.mine.reading import Tell, TraceFile, check, read, silent
from tltlc.tools.mine.vocabulary import MiningVocabulary, of_columns, of_library


def gathered(
    good: Sequence[TraceFile],
    bad: Sequence[TraceFile],
    library: SourceFile | None,
    options: ResolveOptions,
    tell: Tell = silent,
) -> tuple[MiningVocabulary, Evidence, tuple[Diagnostic, ...]]:
    """Return the atoms, the evidence in these atoms, and warnings.

    Without ``bad`` traces, counterexamples are generated.

    Raises:
        TltlError: the errors of :func:`~tltlc.tools.mine.vocabulary.of_library`,
            :func:`~tltlc.tools.mine.vocabulary.of_columns` and
            :func:`~tltlc.tools.mine.reading.read`; for a trace without columns, the reason.
    """
    seen = []
    for file in (*good, *bad):
        tell(f"looking at {file.name}")
        seen.append(Columns(file.name, columns(file.data, file.name)))
        if not seen[-1].columns:
            check(file)
    common = shared([trace.columns for trace in seen])
    odd = uneven(seen, truths=library is None)
    warnings = tuple(group.warning() for group in odd)
    try:
        words = of_columns(common) if library is None else of_library(library, common, options)
    except TltlError as error:
        # The warnings come first, because a trace that differs from the others is the most likely cause.
        raise TltlError((*warnings, *error.diagnostics)) from None
    reported = {name for group in odd for name in group.names}
    rare = dict.fromkeys(name for trace in seen for name in trace.columns if name not in common)
    words = replace(words, left_out=tuple(name for name in (*words.left_out, *rare) if name not in reported))
    traces, notices = read(good, words, tell)
    if not bad:
        return words, with_mutants(traces), (*warnings, *notices)
    counterexamples, bad_notices = read(bad, words, tell)
    contradictions = _contradictions(traces, counterexamples)
    return words, Evidence(traces, counterexamples), (*warnings, *notices, *bad_notices, *contradictions)


def _contradictions(
    traces: Sequence[LabelledTrace], counterexamples: Sequence[LabelledTrace]
) -> tuple[Diagnostic, ...]:
    """Return a warning that names the first trace that equals a counterexample in atoms, if any."""
    known = {trace.letters: trace.name for trace in traces}
    trace_names = {trace.name for trace in traces}
    contradicting = [trace for trace in counterexamples if trace.letters in known]
    if not contradicting:
        return ()
    name = contradicting[0].name
    other = name if name in trace_names else known[contradicting[0].letters]
    suggestion = "move one of them to the other side, or record a signal that tells what differs"
    if len(contradicting) > 1:
        first = f"`{name}`" if name == other else f"`{name}` as `{other}`"
        title = f"{len(contradicting)} of {len(counterexamples)} counterexamples are the same in atoms as a trace"
        title += f" ({first}, for one), and no spec tells them apart"
    elif name == other:
        title = f"`{name}` is a trace and a counterexample, and no spec tells the two apart"
    else:
        title = f"`{name}` and `{other}` are the same in atoms, and no spec tells them apart"
    if name == other:
        suggestion = "name each trace on one side alone"
    return (Diagnostic("TLT0762", title, help=suggestion, severity="warning"),)
