"""Is a recorded trace accepted, and why not?

``find_traces`` finds the traces in files and folders, and ``judge_files`` judges them by the automaton
of a spec. ``clauses_of`` splits the spec into the clauses that a verdict names. ``group_causes`` groups the
traces that are not accepted by the reason, and ``group_text`` and ``group_json`` describe such a group.
``rejection_text`` says why one trace is not accepted.
``measure`` says by how much a comparison holds or fails. ``read_trace`` returns the samples of one trace,
and ``read_tape`` the header and the steps of a tape.
"""

from tltlc.monitor.packed import unpacked
from tltlc.monitor.parquet import as_text
from tltlc.monitor.tapes import DIGEST_STEPS, TapeDigest, TapeHeader, TapeStep
from tltlc.monitor.tapes import VERSION as TAPE_VERSION
from tltlc.monitor.trace_rows import TraceLines, read_tape
from tltlc.monitor.traces import read_trace
from tltlc.tools.judge.clauses import Clauses, clauses_of
from tltlc.tools.judge.judge import Judge
from tltlc.tools.judge.measures import Measure, measure
from tltlc.tools.judge.pool import judge_files
from tltlc.tools.judge.summary import CauseGroup, group_causes, group_json, group_text, rejection_text
from tltlc.tools.judge.trace_files import ENDINGS, TraceFiles, find_traces
from tltlc.tools.judge.verdict import JudgedTrace, Kind, RejectionCause, TraceVerdict

__all__ = [
    "DIGEST_STEPS",
    "ENDINGS",
    "TAPE_VERSION",
    "CauseGroup",
    "Clauses",
    "Judge",
    "JudgedTrace",
    "Kind",
    "Measure",
    "RejectionCause",
    "TapeDigest",
    "TapeHeader",
    "TapeStep",
    "TraceFiles",
    "TraceLines",
    "TraceVerdict",
    "as_text",
    "clauses_of",
    "find_traces",
    "group_causes",
    "group_json",
    "group_text",
    "judge_files",
    "measure",
    "read_tape",
    "read_trace",
    "rejection_text",
    "unpacked",
]
