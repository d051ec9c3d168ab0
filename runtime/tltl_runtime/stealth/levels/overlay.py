"""Overlays: files of small changes to assets (files that levels share).

They are in the folder ``overlays`` beside a level. The variants of the level list them by name.
"""

from __future__ import annotations

from typing import Any

from tltl_runtime.support.suggestion import suggestion
from tltl_runtime.support.toml_tree import Entry, Tree
from tltlc.api import Diagnostic, Label


def apply(overlay: Tree, assets: dict[str, Tree], log: list[Diagnostic]) -> dict[str, Tree]:
    """Return the assets, by name, with the changes of an overlay.

    - ``[change.ASSET]`` replaces values of an asset.
    - ``[change.ASSET.THING]`` replaces values of a thing in the asset.
    - ``[add.ASSET]`` appends to lists of the asset.

    If an asset does not have a key that the overlay changes, add TLT0808 to ``log``, so that a
    misspelled change cannot pass unnoticed. If the overlay itself has an unknown key, add TLT0802.
    """
    changed = dict(assets)
    for key, entry in overlay.items():
        if key == "doc" and isinstance(entry.value, str):
            continue
        if key not in ("change", "add") or not isinstance(entry.value, dict):
            help_ = "use `doc`, `[change.ASSET]` or `[add.ASSET]`"
            log.append(Diagnostic("TLT0802", f"an overlay has no key `{key}` of this kind", (entry.label,), help_))
            continue
        for name, part in entry.value.items():
            if name not in assets or not isinstance(part.value, dict):
                log.append(_missing_error(f"the level uses no asset `{name}`", part.label, name, assets))
            else:
                apply_part = _apply_changes if key == "change" else _apply_additions
                changed[name] = apply_part(changed[name], part.value, f"the asset `{name}`", log)
    return changed


def _apply_changes(target: Tree, changes: Tree, description: str, log: list[Diagnostic]) -> Tree:
    things = {
        item.value["name"].value: (key, number)
        for key, entry in target.items()
        if _is_tables(entry.value)
        for number, item in enumerate(entry.value)
        if "name" in item.value
    }
    result = dict(target)
    for key, entry in changes.items():
        if key in things and isinstance(entry.value, dict):
            kind, number = things[key]
            items = list(result[kind].value)
            changed_thing = _apply_changes(items[number].value, entry.value, f"`{key}` of {description}", log)
            items[number] = Entry(changed_thing, items[number].label)
            result[kind] = Entry(items, result[kind].label)
        elif key in target and key != "name" and not _is_tables(target[key].value):
            result[key] = entry
        else:
            known = [known for known in (*target, *things) if known != "name"]
            log.append(_missing_error(f"{description} has no `{key}` to change", entry.label, key, known))
    return result


def _apply_additions(target: Tree, additions: Tree, description: str, log: list[Diagnostic]) -> Tree:
    result = dict(target)
    for key, entry in additions.items():
        old = target[key].value if key in target else None
        if not isinstance(old, list) or not isinstance(entry.value, list) or _is_tables(old) != _is_tables(entry.value):
            lists = [known for known in target if isinstance(target[known].value, list)]
            log.append(
                _missing_error(f"{description} has no list `{key}` of this kind to add to", entry.label, key, lists)
            )
        else:
            result[key] = Entry([*old, *entry.value], entry.label)
    return result


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], Entry)


def _missing_error(title: str, label: Label, name: str, known: Any) -> Diagnostic:
    return Diagnostic("TLT0808", title, (label,), suggestion(name, known))
