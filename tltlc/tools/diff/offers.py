"""What changed in what a library offers to those who import it."""

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
    from tltlc.tools.diff.library import Offer


def changed_offers(old: Mapping[str, Offer], new: Mapping[str, Offer]) -> Iterator[Diagnostic]:
    """What changed, in the order of the old declarations.

    What is new breaks nothing, and of what both import only the file that declares it tells.
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


def _params(old: Mapping[str, Offer], new: Mapping[str, Offer]) -> Iterator[Diagnostic]:
    ours, theirs = ([each.value for each in offers.values() if isinstance(each.value, Param)] for offers in (old, new))
    found = tuple(named("param", ours, theirs))
    new_names = renamed_params(found)
    for difference in found:
        name = difference.name
        if difference.a is None:
            continue
        if difference.b is None:
            yield say.param(difference, new_names.get(name), say.was(old[name].place))
        elif old[name].is_own or new[name].is_own:
            yield say.param(difference, None, new[name].place)


def _changed(before: Offer, after: Offer) -> Iterator[Diagnostic]:
    """What changed of a signal, predicate or let."""
    why = _other_parameters(before, after)
    if why:
        yield say.other_parameters(after.kind, after.name, after.place, why)
        return
    old, new = before.value, after.value
    if isinstance(old, Signal) and isinstance(new, Signal) and plain(old) != plain(new):
        yield say.signal_type(old, new, after.place)
    # Uses with as few arguments as could be, and with as many.
    for count in (min(before.meanings, default=0), len(before.parameters)):
        if count in before.meanings and count in after.meanings:
            one, other = before.meanings[count], after.meanings[count]
            known = {signal.name for signal in one.signals}
            needed = [signal.name for signal in other.signals if signal.name not in known]
            if needed:
                yield say.reads(after.name, needed, after.place)
            found = apart(one, other)
            if found is not None:
                types: dict[str, ValueType] = {each.name: each.type for each in (*one.signals, *other.signals)}
                yield say.values(f"`{after.name}`", (), found, types, after.place, "predicate")
            if needed or found is not None:
                return


def _other_parameters(before: Offer, after: Offer) -> str | None:
    """Why a use that was right is no longer; None where every one still is."""
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
