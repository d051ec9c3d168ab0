"""Find the changes in what a library offers to its importers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.resolve.spec import Param, Signal
from tltlc.tools.diff import findings as say
from tltlc.tools.diff.differences import named, plain, renamed_params
from tltlc.tools.diff.values import apart

if TYPE_CHECKING:
    from tltlc.resolve.spec import ValueType
    from tltlc.tools.diff.library import OfferedName


def changed_offers(old: Mapping[str, OfferedName], new: Mapping[str, OfferedName]) -> Iterator[Diagnostic]:
    """Yield the changes, in the order of the old declarations.

    New declarations break nothing. Changes of imported declarations are reported only for the file
    that declares them.
    """
    yield from _params(old, new)
    for name, before in old.items():
        after = new.get(name)
        if before.kind == "param":
            continue
        if after is None or after.kind != before.kind:
            yield say.offer_gone(before.kind, name, before.place)
        elif before.is_own or after.is_own:
            yield from _changed(before, after)


def _params(old: Mapping[str, OfferedName], new: Mapping[str, OfferedName]) -> Iterator[Diagnostic]:
    old_params, new_params = (
        [offer.value for offer in offers.values() if isinstance(offer.value, Param)] for offers in (old, new)
    )
    params = tuple(named("param", old_params, new_params))
    new_names = renamed_params(params)
    for difference in params:
        name = difference.name
        if difference.a is None:
            continue
        if difference.b is None:
            yield say.param(difference, new_names.get(name), say.was(old[name].place))
        elif old[name].is_own or new[name].is_own:
            yield say.param(difference, None, new[name].place)


def _changed(before: OfferedName, after: OfferedName) -> Iterator[Diagnostic]:
    """Yield the changes of a signal, predicate or let."""
    why = _other_parameters(before, after)
    if why:
        yield say.other_parameters(after.kind, after.name, after.place, why)
        return
    old, new = before.value, after.value
    if isinstance(old, Signal) and isinstance(new, Signal) and plain(old) != plain(new):
        yield say.signal_type(old, new, after.place)
    # Compare the uses with the fewest and with the most arguments.
    for count in (min(before.meanings, default=0), len(before.parameters)):
        if count in before.meanings and count in after.meanings:
            one, other = before.meanings[count], after.meanings[count]
            known = {signal.name for signal in one.signals}
            needed = [signal.name for signal in other.signals if signal.name not in known]
            if needed:
                yield say.reads(after.name, needed, after.place)
            sample = apart(one, other)
            if sample is not None:
                types: dict[str, ValueType] = {signal.name: signal.type for signal in (*one.signals, *other.signals)}
                yield say.values(f"`{after.name}`", (), sample, types, after.place, "predicate")
            if needed or sample is not None:
                return


def _other_parameters(before: OfferedName, after: OfferedName) -> str | None:
    """Return why a formerly valid use is no longer valid; None if all uses still are."""
    if before.kind == "signal":
        count, now = len(before.parameters), len(after.parameters)
        return None if count == now else f"{now} where there were {count}"
    for old, new in zip(before.parameters, after.parameters, strict=False):
        if old.name != new.name:
            return f"`{new.name}` stands where `{old.name}` stood"
        if old.type != new.type and new.type is not None:
            return f"`{new.name}` is of another type"
        if old.default is not None and new.default is None:
            return f"`{new.name}` has no default any more"
    if len(after.parameters) < len(before.parameters):
        return f"`{before.parameters[len(after.parameters)].name}` is gone"
    for added in after.parameters[len(before.parameters) :]:
        if added.default is None:
            return f"`{added.name}` must be given, too"
    return None
