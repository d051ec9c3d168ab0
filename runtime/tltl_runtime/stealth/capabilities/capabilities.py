"""Check that a level supplies what a spec uses: entities, signals, clock and params."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, isclose
from typing import Final

from tltl_runtime.spec.spec_places import SpecPlaces
from tltl_runtime.stealth.capabilities.vocabulary import AvailableSignal, available_signals, params
from tltl_runtime.stealth.level import StealthLevel, entity_names
from tltl_runtime.stealth.levels.default_spec import is_packaged
from tltl_runtime.stealth.signals import signal_list
from tltl_runtime.stealth.world.player import DECISION
from tltl_runtime.support.suggestion import suggestion
from tltlc.api import Diagnostic, Fspa, Signal, TltlError, monitors, specs

_KIND_OF: Final = {"active": "switch", "open": "barrier"}
"""The kind of entity that has a signal, for the signals that only one kind has."""

_ARTICLE: Final = {"angle": "an angle"}


def check_capabilities(level: StealthLevel, fspa: Fspa, places: SpecPlaces) -> list[Diagnostic]:
    """Return diagnostics for everything that a spec uses and a level does not supply.

    ``fspa`` is the automaton of the spec. ``places`` finds the places in the spec's source that
    the diagnostics point to.

    - TLT0810, error: the level has no such entity.
    - TLT0811, error: the level has no such signal.
    - TLT0812: the level's signal has another type than the spec declares (error), or values outside
      the declared range (warning).
    - TLT0617, error: the spec's clock (its sampling interval) is not the game's time step.
    - TLT0307, error: the level's value of a parameter is outside the range that the spec declares.
    - TLT0813, warning: the spec names another level.
    """
    diagnostics = [*_check_signals(level, fspa, places)]
    if fspa.level is not None and fspa.level != level.name:
        title = f"`{fspa.name}` is made for the level `{fspa.level}`, not for `{level.name}`"
        help_ = f"if the spec is meant for `{level.name}`, write `level {level.name}` in it"
        labels = places.level()
        if labels and is_packaged(labels[0].source.name):
            help_ = (
                f"this spec comes with tltlc: `tltlc new FOLDER --level {fspa.level}` copies it with its level; "
                f"write `level {level.name}` in the copy, and put the copy beside `{level.name}.toml`"
            )
        diagnostics.append(Diagnostic("TLT0813", title, labels, help_, "warning"))
    if fspa.clock_s is not None and not isclose(fspa.clock_s, DECISION, rel_tol=1e-9):
        title = f"`{fspa.name}` is sampled every {fspa.clock_s:g} s, but a step of the game takes {DECISION:g} s"
        help_ = f"write `clock {DECISION:g} s` in the specification"
        diagnostics.append(Diagnostic("TLT0617", title, places.clock(), help_))
    try:
        monitors.param_values(fspa.params, params_from_level(level, fspa))
    except TltlError as error:
        diagnostics += error.diagnostics
    return diagnostics


def params_from_level(level: StealthLevel, fspa: Fspa) -> dict[str, float]:
    """Return the values that the level defines for the spec's parameters, in SI units, by name.

    Parameters that the level does not define are left out.
    """
    declared = {param.name for param in fspa.params}
    return {name: value for name, value in params(level).items() if name in declared}


def used_entities(level: StealthLevel, fspa: Fspa) -> tuple[str, ...]:
    """Return the entities of a level that a spec's signals mention, such as E in ``distance(E)``.

    The names are in the order of the signals.
    """
    entities = entity_names(level)
    return tuple(dict.fromkeys(name for signal in fspa.signals for name in signal.arguments if name in entities))


def _check_signals(level: StealthLevel, fspa: Fspa, places: SpecPlaces) -> Iterator[Diagnostic]:
    available, entities = available_signals(level), entity_names(level)
    missing: set[str] = set()
    for signal in fspa.signals:
        unknown = [name for name in signal.arguments if name not in entities]
        for name in unknown:
            if name not in missing:
                missing.add(name)
                title = f"the level `{level.name}` has no entity `{name}`"
                yield Diagnostic("TLT0810", title, places.entity(name), suggestion(name, entities))
        if unknown:
            continue
        if signal.name in available:
            yield from _check_declaration(signal, available[signal.name], level, places)
        else:
            title = f"the level `{level.name}` has no signal `{signal.name}`"
            yield Diagnostic("TLT0811", title, places.signal(signal), _hint(signal, level, available))


def _check_declaration(
    signal: Signal, available: AvailableSignal, level: StealthLevel, places: SpecPlaces
) -> Iterator[Diagnostic]:
    """Yield a diagnostic (TLT0812) if the level's signal does not fit its declaration in the spec.

    ``available`` describes the level's signal, and ``signal`` is the declaration. Another type is
    an error; values outside the declared range are a warning.
    """
    needs_bool = signal.type == "bool" and available.type != "bool"
    if needs_bool or specs.TYPES[signal.type] != specs.TYPES[available.type]:
        title = (
            f"`{signal.name}` is {_with_article(signal.type)} in the spec, "
            f"but the level `{level.name}` supplies {_with_article(available.type)}"
        )
        help_ = f"declare it as {_with_article(available.type)}, or rename it if you mean another signal"
        yield Diagnostic("TLT0812", title, places.declaration(signal), help_)
        return
    low, high = _ends(signal.low, signal.high)
    least, most = _ends(available.low, available.high)
    if least < low or most > high:
        title = (
            f"`{signal.name}` is in {monitors.range_text(signal.low, signal.high)} in the spec, "
            f"but in {monitors.range_text(*_rounded_range(available))} in the level `{level.name}`"
        )
        help_ = "widen its range: a value outside it counts as the nearest value inside"
        yield Diagnostic("TLT0812", title, places.declaration(signal), help_, "warning")


def _hint(signal: Signal, level: StealthLevel, available: dict[str, AvailableSignal]) -> str:
    if signal.arguments and signal.base in _KIND_OF:
        kind = _KIND_OF[signal.base]
        known = [entity.name for entity in (level.switches if kind == "switch" else level.barriers)]
        return f"its argument must be a {kind}: {suggestion(', '.join(signal.arguments), known)}"
    known_names = suggestion(signal.name, available, signal_list(level))
    return f"{known_names}\na level can give its signals other names under `[signals]`"


def _ends(low: float | None, high: float | None) -> tuple[float, float]:
    return -inf if low is None else low - 1e-6, inf if high is None else high + 1e-6


def _rounded_range(available: AvailableSignal) -> tuple[float | None, float | None]:
    low, high = available.low, available.high
    return (None if low is None else round(low, 3)), (None if high is None else round(high, 3))


def _with_article(type_: str) -> str:
    return _ARTICLE.get(type_, f"a {type_}")
