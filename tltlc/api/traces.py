"""Is a recorded trace accepted, and why not?

``find_traces`` finds the traces in files and folders, and ``judge_files`` judges them by the automaton
of a spec. ``clauses_of`` splits the spec into the clauses that a verdict names. ``read_trace`` returns
the samples of one trace.
"""

from tltlc.monitor.parquet import as_text
from tltlc.monitor.traces import read_trace
from tltlc.tools.judge.clauses import clauses_of
from tltlc.tools.judge.judge import Judge
from tltlc.tools.judge.pool import judge_files
from tltlc.tools.judge.trace_files import ENDINGS, TraceFiles, find_traces
from tltlc.tools.judge.verdict import JudgedTrace, Kind, TraceVerdict

__all__ = [
    "ENDINGS",
    "Judge",
    "JudgedTrace",
    "Kind",
    "TraceFiles",
    "TraceVerdict",
    "as_text",
    "clauses_of",
    "find_traces",
    "judge_files",
    "read_trace",
]
