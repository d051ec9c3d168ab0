"""Check whether a scene supplies what a spec uses: signals, params and the clock."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from math import inf, isclose
from typing import Any, Final, SupportsFloat

from tltl_runtime.gymnasium_games.plays import PlayedMoment
from tltl_runtime.spec.spec_places import SpecPlaces
from tltl_runtime.support.suggestion import suggestion
from tltlc.api import Diagnostic, Fspa, MonitorError, Signal, TltlError, monitors, record

_ROUNDING: Final = 1e-6
_MOST_LISTED: Final = 30


@record
class Supply:
    """What a scene supplies to specs.

    ``moments`` are the moments of a play, with the signals. ``params`` is the result of ``tltl_params``;
    None if the game has no such method. ``clock_s`` is the length of a step in seconds; None if it is
    unknown.
    """

    scene: str
    moments: Sequence[PlayedMoment]
    params: Mapping[str, SupportsFloat] | None
    clock_s: float | None


def check_fit(supply: Supply, fspa: Fspa, places: SpecPlaces) -> list[Diagnostic]:
    """Return diagnostics for everything that a spec uses and a scene does not supply.

    ``fspa`` is the automaton of the spec. ``places`` finds the places in the spec's source that the
    diagnostics point to.

    - TLT0811, error: the game has no such signal.
    - TLT0612, error: a signal has a value that monitors refuse.
    - TLT0812, warning: a signal has a value outside the range that the spec declares.
    - TLT0782: the game has no such param. It is a note, but a warning if a param has a similar name.
    - TLT0307, error: the game's value of a param is outside the range that the spec declares.
    - TLT0617, error: the spec's clock differs from the game's, or it varies and the game has none.
    - TLT0813, warning: the spec names another level.
    """
    diagnostics = [diagnostic for signal in fspa.signals for diagnostic in _check_signal(supply, signal, places)]
    diagnostics += _check_params(supply, fspa, places)
    if fspa.clock_varies and not supply.clock_s:
        title = f"the clock of `{fspa.name}` varies, and the game does not say how long its steps are"
        help_ = 'write how long a step takes in the game file, e.g. `clock = "10 Hz"`'
        diagnostics.append(Diagnostic("TLT0617", title, places.clock(), help_))
    if fspa.clock_s is not None and supply.clock_s and not isclose(fspa.clock_s, supply.clock_s, rel_tol=1e-9):
        own, step = monitors.number_text(fspa.clock_s), monitors.number_text(supply.clock_s)
        title = f"`{fspa.name}` is sampled every {own} s, but a step of the game takes {step} s"
        diagnostics.append(Diagnostic("TLT0617", title, places.clock(), f"write `clock {step} s` in the specification"))
    if fspa.level not in (None, supply.scene):
        title = f"`{fspa.name}` is made for the level `{fspa.level}`, not for the scene `{supply.scene}`"
        help_ = f"if the spec is meant for `{supply.scene}`, write `level {supply.scene}` in it"
        diagnostics.append(Diagnostic("TLT0813", title, places.level(), help_, "warning"))
    return diagnostics


def _check_signal(supply: Supply, signal: Signal, places: SpecPlaces) -> Iterator[Diagnostic]:
    """Yield diagnostics for the first moment of the play at which a signal is wrong; nothing if it never is."""
    low = -inf if signal.low is None else signal.low - _ROUNDING
    high = inf if signal.high is None else signal.high + _ROUNDING
    for moment in supply.moments:
        when = f"at step {moment.step}" if moment.step else "after the reset"
        if signal.name not in moment.sample:
            title = f"the scene `{supply.scene}` has no signal `{signal.name}`"
            title += f" {when}" if moment.step else ""
            yield Diagnostic("TLT0811", title, places.signal(signal), _known_signals(signal.name, moment.sample))
            return
        try:
            value = monitors.finite_signal_value(signal, moment.sample[signal.name], when)
        except MonitorError as error:
            for diagnostic in error.diagnostics:
                yield Diagnostic(diagnostic.code, diagnostic.title, places.signal(signal), diagnostic.help)
            return
        if signal.type == "bool" and value not in (0.0, 1.0):
            title = f"{when}: the signal `{signal.name}` is {value:g}, neither true nor false"
            help_ = "return a bool, or declare the signal as a number"
            yield Diagnostic("TLT0612", title, places.declaration(signal), help_)
            return
        if not low <= value <= high:
            declared = monitors.range_text(signal.low, signal.high)
            title = f"`{signal.name}` is in {declared} in the spec, but {value:g} {when} in the scene `{supply.scene}`"
            help_ = "widen its range: a value outside it counts as the nearest value inside"
            yield Diagnostic("TLT0812", title, places.declaration(signal), help_, "warning")
            return


def _known_signals(name: str, sample: Mapping[str, Any]) -> str:
    """Return the hint for a signal ``name`` that ``sample`` lacks: a similar name in the sample, or its names."""
    if len(sample) <= _MOST_LISTED:
        return suggestion(name, map(str, sample))
    listed = ", ".join(f"`{known}`" for known in [*sample][:_MOST_LISTED])
    return suggestion(name, map(str, sample), f"{listed}, …")


def _check_params(supply: Supply, fspa: Fspa, places: SpecPlaces) -> Iterator[Diagnostic]:
    if supply.params is None:
        return
    declared = {param.name for param in fspa.params}
    others = [name for name in supply.params if name not in declared]
    for param in fspa.params:
        if param.name not in supply.params:
            close = get_close_matches(param.name, others, n=1)
            title = f"the game gives no value to `{param.name}`, so it has its default, {param.value:g}"
            help_ = f"did you mean `{close[0]}`?" if close else "this is right if the spec alone sets it"
            yield Diagnostic("TLT0782", title, places.param(param.name), help_, "warning" if close else "note")
            continue
        try:
            monitors.param_values((param,), {param.name: float(supply.params[param.name])})
        except TltlError as error:
            for diagnostic in error.diagnostics:
                yield Diagnostic(diagnostic.code, diagnostic.title, places.param(param.name), diagnostic.help)
