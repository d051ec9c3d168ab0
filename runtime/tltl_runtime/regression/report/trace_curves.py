"""The values of atoms over the steps of recorded traces and episodes, for pictures.

The files of recorded traces are read again for this.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice
from typing import Final, Literal

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.explain.explained_episode import Arrival, arrivals_of
from tltl_runtime.regression.explain.trace_ends import trace_end_text
from tltl_runtime.regression.verdict.judged_traces import JudgedTraces
from tltlc.api import Fspa, TltlError, fileio, monitors, record, traces

_EXAMPLES: Final = 3
"""At most this many traces of each finding are drawn."""


@record
class TraceCurves:
    """The data for the picture of a recorded trace or of a recorded episode; ``kind`` says of which.

    ``name`` is the path of the trace, or the number of the episode. ``ended`` says in words how the
    trace or episode ended. ``atoms`` has, for each of the ``steps`` samples, the values of all atoms, in
    [-1, 1]. ``arrivals`` are the entries into states of the automaton.
    """

    name: str
    ended: str
    atoms: tuple[tuple[float, ...], ...]
    arrivals: tuple[Arrival, ...]
    kind: Literal["trace", "episode"] = "trace"
    is_accepted: bool = False

    @property
    def steps(self) -> int:
        """The number of samples."""
        return len(self.atoms)


def example_curves(judged: JudgedTraces, findings: Sequence[Finding]) -> dict[int, TraceCurves]:
    """Return the curves of example traces by the index of the trace.

    The examples are the first ``_EXAMPLES`` traces of each finding, and the first accepted trace. A
    trace is left out if its file was removed since it was judged, or now leads to other states.
    """
    accepted = [trace.summary.index for trace in judged.now.episodes if trace.summary.success]
    wanted = {*(index for finding in findings for index in finding.episodes[:_EXAMPLES]), *accepted[:1]}
    return {index: curves for index in sorted(wanted) for curves in _curves(judged, index)}


def episode_curves(index: int, episode: RecordedEpisode) -> TraceCurves:
    """Return the curves of a recorded episode; ``index`` is its number."""
    return TraceCurves(
        name=str(index),
        ended=episode.level.game.cause(episode).text,
        atoms=tuple(map(tuple, episode.atoms.tolist())),
        arrivals=arrivals_of(episode),
        kind="episode",
        is_accepted=episode.success,
    )


def _curves(judged: JudgedTraces, index: int) -> Iterator[TraceCurves]:
    name, trace, fspa = judged.now.names[index], judged.now.episodes[index], judged.fspa
    with suppress(TltlError):
        data = fileio.read_bytes(name, name, fileio.limits.JUDGED_TRACE.size)
        judge = traces.Judge(fspa, episodes=judged.case.as_episodes, details=True)
        verdict = judge.judge(name, data).verdict
        arrivals = tuple((arrival.state, arrival.step) for arrival in trace.arrivals)
        if verdict is None or verdict.details is None or verdict.details.arrivals != arrivals:
            return
        rows = tuple(_atom_values(fspa, name, data, trace.summary.steps))
        is_accepted = trace.summary.success
        ended = "accepted" if is_accepted else trace_end_text(fspa, trace.cause, trace.by, [trace])
        yield TraceCurves(name, ended, rows, trace.arrivals, is_accepted=is_accepted)


def _atom_values(fspa: Fspa, name: str, data: bytes, steps: int) -> Iterator[tuple[float, ...]]:
    """Yield the values of all atoms at each of the first ``steps`` samples of a trace."""
    samples = monitors.Samples(fspa, None, [])
    text = io.BytesIO(traces.as_text(data, name, fspa.signals))
    read = traces.read_trace(text, name, fspa.signals, fspa.clock_s, clock_varies=fspa.clock_varies)
    for values in samples.of_trace(list(islice(read, steps))):
        yield values.atoms
