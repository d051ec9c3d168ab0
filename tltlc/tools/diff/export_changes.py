"""Find the changes in the declarations that a library exports."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.resolve.spec import Param, Signal
from tltlc.tools.diff import findings
from tltlc.tools.diff.differences import declared_differences, new_param_names, type_and_range
from tltlc.tools.diff.values import value_difference

if TYPE_CHECKING:
    from tltlc.resolve.spec import ValueType
    from tltlc.tools.diff.library import Export


def export_changes(old: Mapping[str, Export], new: Mapping[str, Export]) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each declaration of a library that was changed or removed.

    ``old`` and ``new`` map names to declarations. Diagnostics about params come first, then the
    others in the order of the old declarations. New declarations break nothing, so they are left
    out. A changed declaration is reported only for the file that contains it, not for the files that
    import it.
    """
    yield from _param_changes(old, new)
    for name, before in old.items():
        after = new.get(name)
        if before.kind == "param":
            continue
        if after is None or after.kind != before.kind:
            yield findings.declaration_removed(before.kind, name, before.place)
        elif before.is_own or after.is_own:
            yield from _declaration_changes(before, after)


def _param_changes(old: Mapping[str, Export], new: Mapping[str, Export]) -> Iterator[Diagnostic]:
    old_params, new_params = (
        [export.value for export in exports.values() if isinstance(export.value, Param)] for exports in (old, new)
    )
    params = tuple(declared_differences("param", old_params, new_params))
    new_names = new_param_names(params)
    for difference in params:
        name = difference.name
        if difference.a is None:
            continue
        if difference.b is None:
            yield findings.param_changed(difference, new_names.get(name), findings.at_old_place(old[name].place))
        elif old[name].is_own or new[name].is_own:
            yield findings.param_changed(difference, None, new[name].place)


def _declaration_changes(before: Export, after: Export) -> Iterator[Diagnostic]:
    """Yield diagnostics for the changes between two versions of a signal, predicate or let."""
    why = _why_uses_break(before, after)
    if why:
        yield findings.parameters_changed(after.kind, after.name, after.place, why)
        return
    old, new = before.value, after.value
    if isinstance(old, Signal) and isinstance(new, Signal) and type_and_range(old) != type_and_range(new):
        yield findings.signal_type_changed(old, new, after.place)
    # Compare the uses with the fewest and with the most arguments.
    for count in (min(before.meanings, default=0), len(before.parameters)):
        if count in before.meanings and count in after.meanings:
            old_meaning, new_meaning = before.meanings[count], after.meanings[count]
            old_signals = {signal.name for signal in old_meaning.signals}
            new_signals = [signal.name for signal in new_meaning.signals if signal.name not in old_signals]
            if new_signals:
                yield findings.signals_added(after.name, new_signals, after.place)
            difference = value_difference(old_meaning, new_meaning)
            if difference is not None:
                types: dict[str, ValueType] = {
                    signal.name: signal.type for signal in (*old_meaning.signals, *new_meaning.signals)
                }
                yield findings.values_changed(f"`{after.name}`", (), difference, types, after.place, "predicate")
            if new_signals or difference is not None:
                return


def _why_uses_break(before: Export, after: Export) -> str | None:
    """Say why some uses of a declaration are no longer valid: ```close` must now be given, too``.

    Return None if all uses are still valid.
    """
    if before.kind == "signal":
        count, now = len(before.parameters), len(after.parameters)
        return None if count == now else f"{now} instead of {count}"
    for old, new in zip(before.parameters, after.parameters, strict=False):
        if old.name != new.name:
            return f"`{new.name}` is now in the place of `{old.name}`"
        if old.type != new.type and new.type is not None:
            return f"`{new.name}` has another type"
        if old.default is not None and new.default is None:
            return f"`{new.name}` has no default any more"
    if len(after.parameters) < len(before.parameters):
        return f"`{before.parameters[len(after.parameters)].name}` is gone"
    for added in after.parameters[len(before.parameters) :]:
        if added.default is None:
            return f"`{added.name}` must now be given, too"
    return None
