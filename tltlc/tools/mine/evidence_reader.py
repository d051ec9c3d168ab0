"""Read trace files: find the atoms, read at which samples they hold, and report contradictions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.monitor.sample_times import times_name
from tltlc.resolve.options import ResolveOptions
from tltlc.tools.mine.column_diagnostics import TraceColumns, odd_columns
from tltlc.tools.mine.columns import ColumnKind, columns, common_columns
from tltlc.tools.mine.evidence import Evidence, LabelledTrace
from tltlc.tools.mine.mutants import with_mutants
from tltlc.tools.mine.trace_clock import clock_declaration, trace_clock
from tltlc.tools.mine.trace_letters import (
    ProgressCallback,
    TraceFile,
    check_trace,
    consistent,
    ignore_progress,
    read_traces,
)
from tltlc.tools.mine.vocabulary import MiningVocabulary, vocabulary_of_columns, vocabulary_of_library


def read_evidence(
    good: Sequence[TraceFile],
    bad: Sequence[TraceFile],
    library: SourceFile | None,
    options: ResolveOptions,
    report_progress: ProgressCallback = ignore_progress,
) -> tuple[MiningVocabulary, Evidence, tuple[Diagnostic, ...]]:
    """Return the atoms of the traces (the vocabulary), at which samples they hold (the evidence), and warnings.

    ``good`` are the traces, and ``bad`` the counterexamples. If ``bad`` is empty, counterexamples are
    generated. The atoms are predicates of ``library``; without a library, they are the columns that
    have only the values `true` and `false`, and ``column > 0`` for columns of robustness values.

    Raises:
        TltlError: the errors of :func:`~tltlc.tools.mine.vocabulary.vocabulary_of_library`,
            :func:`~tltlc.tools.mine.vocabulary.vocabulary_of_columns` and
            :func:`~tltlc.tools.mine.trace_letters.read_traces`; the errors of
            :func:`~tltlc.tools.mine.trace_letters.check_trace` for a trace without columns.
    """
    all_columns = []
    for file in (*good, *bad):
        report_progress(f"looking at {file.name}")
        all_columns.append(TraceColumns(file.name, columns(file.data, file.name, file.kind)))
        if not all_columns[-1].columns:
            check_trace(file)
    common = common_columns([trace.columns for trace in all_columns])
    odd = odd_columns(all_columns, common if library is None else None)
    warnings = tuple(group.warning() for group in odd)
    try:
        vocabulary = (
            vocabulary_of_columns(common, _clock((*good, *bad), common))
            if library is None
            else vocabulary_of_library(library, common, options)
        )
    except TltlError as error:
        # The warnings come first, because a trace that differs from the others is the most likely cause.
        raise TltlError((*warnings, *error.diagnostics)) from None
    reported = {name for group in odd for name in group.names}
    rare = dict.fromkeys(name for trace in all_columns for name in trace.columns if name not in common)
    vocabulary = replace(
        vocabulary, left_out=tuple(name for name in (*vocabulary.left_out, *rare) if name not in reported)
    )
    traces, notices = read_traces(good, vocabulary, report_progress)
    reader = vocabulary.reader
    if not bad:
        evidence = with_mutants(traces, lambda letters: consistent(letters, reader))
        evidence = replace(evidence, clock_s=reader.clock_s, clock_varies=reader.clock_varies)
        return vocabulary, evidence, (*warnings, *notices)
    counterexamples, bad_notices = read_traces(bad, vocabulary, report_progress)
    contradictions = _contradictions(traces, counterexamples)
    evidence = Evidence(traces, counterexamples, clock_s=reader.clock_s, clock_varies=reader.clock_varies)
    return vocabulary, evidence, (*warnings, *notices, *bad_notices, *contradictions)


def _clock(files: Sequence[TraceFile], columns: Mapping[str, ColumnKind]) -> str:
    """Return the declaration of the clock of traces without a library; empty if their times show none."""
    name = times_name(columns, ())
    # A column of true and false is a signal, whatever its name.
    return "" if name is None or columns[name] == ColumnKind.TRUTHS else clock_declaration(trace_clock(files))


def _contradictions(
    traces: Sequence[LabelledTrace], counterexamples: Sequence[LabelledTrace]
) -> tuple[Diagnostic, ...]:
    """Return a warning, TLT0762, if some counterexample has the same atoms as a trace at every step.

    The warning names the first such counterexample. Without one, the result is empty.
    """
    names_by_letters = {trace.letters: trace.name for trace in traces}
    trace_names = {trace.name for trace in traces}
    contradicting = [trace for trace in counterexamples if trace.letters in names_by_letters]
    if not contradicting:
        return ()
    name = contradicting[0].name
    other = name if name in trace_names else names_by_letters[contradicting[0].letters]
    help_ = "move one of them to the other side, or record a signal that shows the difference"
    if len(contradicting) > 1:
        first = f"`{name}`" if name == other else f"`{name}` and `{other}`"
        title = f"{len(contradicting)} of {len(counterexamples)} counterexamples have the same atoms as a trace at "
        title += f"every step ({first}, for example), so no spec can tell them apart"
    elif name == other:
        title = f"`{name}` is both a trace and a counterexample, so no spec can tell the two apart"
    else:
        title = f"`{name}` and `{other}` have the same atoms at every step, so no spec can tell them apart"
    if name == other:
        help_ = "name each trace on only one side"
    return (Diagnostic("TLT0762", title, help=help_, severity="warning"),)
