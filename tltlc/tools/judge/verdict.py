"""The verdict of a recorded trace, and why a trace is not accepted."""

from __future__ import annotations

from typing import Literal

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.nearest_edge import NearestEdge
from tltlc.monitor.run import TraceOutcome

Kind = Literal["broken", "blocked", "late", "unfinished"]


@record
class RejectionCause:
    """Why a trace is not accepted. ``step`` counts samples from 1.

    - ``broken``: from ``step`` on, no continuation can meet the ``clauses``.
    - ``blocked``: from ``step`` on, no continuation can meet the ``clauses`` without breaking others.
    - ``late``: the episode reaches its limit, ``step``, before the ``clauses`` are met. Only for
      traces that are judged as episodes.
    - ``unfinished``: the trace ends, after ``step`` samples, before the ``clauses`` are met.

    ``clauses`` are texts, as in :class:`~tltlc.tools.judge.clauses.ClauseAutomaton`. They are empty if no
    single clause is to blame, but only several together, or if the clauses are not known. ``atoms``
    are the atoms that decided the step that broke the spec; empty for ``late`` and ``unfinished``.
    """

    kind: Kind
    step: int
    clauses: tuple[str, ...]
    atoms: tuple[str, ...] = ()


@record
class TraceDetails:
    """How a trace moved through the automaton.

    ``arrivals`` are the entries into states, in order: pairs of a state and the number of samples
    before it. The first is the initial state, after 0 samples. ``unmet`` is the state at the end, or
    the state before the sample that broke the spec. If the trace is not accepted, ``nearest`` says how
    near its last stay in the state ``unmet`` came to an edge that leads towards acceptance; ``row``
    counts the samples of that stay. It is None if the trace is accepted, or if there is no such edge or
    no sample in the stay.
    """

    arrivals: tuple[tuple[int, int], ...]
    unmet: int
    nearest: NearestEdge | None


@record
class TraceVerdict:
    """The verdict of a trace.

    ``remaining`` is the label of the last state: what remains to be satisfied. ``cause`` is None if
    the trace is accepted. ``samples`` is the number of samples in the trace. If the trace is judged
    as an episode and the episode ends earlier, ``outcome.steps`` is less than ``samples``. ``details``
    is None unless they were asked for.
    """

    outcome: TraceOutcome
    remaining: str
    cause: RejectionCause | None
    samples: int
    details: TraceDetails | None = None


@record
class JudgedTrace:
    """A trace with its ``verdict``; the verdict is None if the trace cannot be judged.

    ``name`` is the name of the trace in messages. If the trace cannot be judged, the first of
    ``diagnostics`` is the error that says why; otherwise they are warnings. ``so_far`` is set if the
    samples before the error already break the spec: then it says how.
    """

    name: str
    verdict: TraceVerdict | None
    diagnostics: tuple[Diagnostic, ...] = ()
    so_far: RejectionCause | None = None
