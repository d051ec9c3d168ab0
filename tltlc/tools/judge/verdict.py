"""The verdict of a recorded trace, and why a trace is not accepted."""

from __future__ import annotations

from typing import Literal

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.nearest_edge import NearestEdge
from tltlc.monitor.run import TraceOutcome
from tltlc.tools.judge.measures import Measure

Kind = Literal["broken", "blocked", "late", "unfinished"]


@record
class RejectionCause:
    """Why a trace is not accepted.

    ``step`` is the number of a sample, from 1. ``kind`` is one of these:

    - ``broken``: from ``step`` on, no continuation can meet the ``clauses``.
    - ``blocked``: from ``step`` on, no continuation can meet the ``clauses`` without breaking others.
    - ``late``: the episode reaches its limit, at ``step``, before the ``clauses`` are met. Only for
      traces that are judged as episodes.
    - ``unfinished``: the trace ends at ``step``, before the ``clauses`` are met.

    ``clauses`` has the texts of the clauses to blame: ``avoid on_lava``. It is empty if no single
    clause is to blame, only several together, or if the clauses are not known. ``atoms`` has the
    names of the atoms whose values at ``step`` broke the spec. It is empty for ``late`` and
    ``unfinished``. ``measure`` says how far the first of them that is a comparison was from holding, or
    from not holding; None if none of them is a comparison. ``words`` has the same atoms in words, such as
    "hidden later than 5 s after alarm" for a deadline; it is empty if the spec has no memory.
    """

    kind: Kind
    step: int
    clauses: tuple[str, ...]
    atoms: tuple[str, ...] = ()
    measure: Measure | None = None
    words: tuple[str, ...] = ()


@record
class TraceDetails:
    """How a trace moved through the automaton.

    ``arrivals`` has a pair for each change of state: the new state, and how many samples it took to
    get there. The first pair is ``(0, 0)``, for the initial state. ``unmet`` is the state before the
    sample that broke the spec, or the last state if no sample broke it.

    ``nearest`` is about the steps that the trace spent in ``unmet`` the last time. It says which of
    them came nearest to an edge that leads towards acceptance; ``nearest.row`` is the index of this
    step among them. ``nearest`` is None if the trace is accepted, if there is no such edge, or if
    there are no such steps. ``missed`` is the measure of the atom that ``nearest`` names, at this step;
    None if it is no comparison.
    """

    arrivals: tuple[tuple[int, int], ...]
    unmet: int
    nearest: NearestEdge | None
    missed: Measure | None = None


@record
class TraceVerdict:
    """The verdict of a trace.

    ``remaining`` is the label of the last state: the formula that remains to be satisfied. ``cause``
    is None if the trace is accepted. ``samples`` is the number of samples in the trace; it is greater
    than ``outcome.steps`` if the trace is judged as an episode and the episode ends earlier.
    ``unmet`` says in words what remained to be satisfied before the sample that broke the spec, or at the
    end of the trace if no sample broke it. ``details`` is None unless the caller of
    :class:`~tltlc.tools.judge.judge.Judge` asked for details.
    """

    outcome: TraceOutcome
    remaining: str
    cause: RejectionCause | None
    samples: int
    details: TraceDetails | None = None
    unmet: str = ""


@record
class JudgedTrace:
    """The result of judging one trace.

    ``name`` is the name of the trace in messages. If the trace cannot be judged, ``verdict`` is None,
    and the first of ``diagnostics`` is the error that says why. Otherwise ``diagnostics`` are
    warnings. ``so_far`` is the cause if the samples before the error already break the spec; in all
    other cases it is None.
    """

    name: str
    verdict: TraceVerdict | None
    diagnostics: tuple[Diagnostic, ...] = ()
    so_far: RejectionCause | None = None
