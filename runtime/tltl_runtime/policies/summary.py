"""Summaries of policies: their tasks, inputs and outputs, and the results of their training."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.spaces.refusals import name_of
from tltl_runtime.support.number_text import column, share
from tltl_runtime.support.record_json import to_json
from tltlc.api import formula_text, label_text

_ENDS: Final[Mapping[str, str]] = {
    "met": "the spec was met",
    "steps": "by the limit of steps",
    "minutes": "by the limit of minutes",
}
"""Why a training ended, in words, by the ``end`` of its record."""
_KINDS: Final[Mapping[str, str]] = {"numbers": "numbers", "image": "image", "grid": "grid of categories"}
"""The kinds of the parts of an observation, in words, except ``categories``."""


def summary(policy: Policy) -> dict[str, Any]:
    """Return a summary of a policy as JSON data, from its card.

    The key ``spaces`` is missing if the card has no ``spaces``.
    """
    card = policy.card
    values = {
        "level": card.level,
        "variant": card.variant,
        "level_hash": card.level_hash,
        "spec": card.fspa.name,
        "spec_hash": spec_hash(card.fspa),
        "formula": str(card.fspa.formula),
        "english": formula_text(card.fspa),
        "params": dict(card.params),
        "states": [label_text(card.fspa, state.id) for state in card.fspa.states],
        "observation": dict(card.shapes),
        "sensors": to_json(card.sensors),
        "branches": card.branches,
        "network": to_json(card.network),
        "weights": policy.weight_count(),
        "reward": to_json(card.reward),
        "versions": dict(card.versions),
        "training": to_json(card.training),
    }
    return values if card.spaces is None else {**values, "spaces": to_json(card.spaces)}


def summary_text(values: Mapping[str, Any]) -> str:
    """Return the result of :func:`summary` as text for a terminal.

    Replace unprintable characters, which the names in an untrusted file may have, by U+FFFD.
    """
    sensors, network, layouts = values["sensors"], values["network"], values.get("spaces")
    map_ = sensors["map"]
    layers = " + ".join(map(str, network["hidden"]))
    if map_ is not None or (layouts and any(part["kind"] in ("image", "grid") for part in layouts["observation"])):
        layers = f"convolution {' + '.join(map(str, network['channels']))}, then {layers}"
    rows = {
        "level": f"{values['level']} {values['variant']} (hash {values['level_hash'][:12]})",
        "spec": f"{values['spec']} (hash {values['spec_hash'][:12]}): {values['english']}",
        "senses": ", ".join(map(_observation_part, layouts["observation"]))
        if layouts
        else ", ".join((*sensors["entities"], *sensors["variables"])) or "neither entities nor variables",
        "chooses": ", ".join(map(_action_part, layouts["action"]["parts"])) if layouts else "",
        "map": _map(map_) if map_ else "",
        "network": f"{layers} ({network['activation']}), {values['weights']:,} weights",
        "training": _training(values["training"]),
        "initial": _initial_policy(values["training"]),
        "kept": _best_policy(values["training"]),
        "ended": _ENDS.get(str(values["training"].get("end")), ""),
        "search": _search(values["training"]),
        "imitated": _demonstrations(values["training"]),
        "versions": ", ".join(f"{name} {version}" for name, version in values["versions"].items()),
    }
    printable = {
        name: "".join(char if char.isprintable() else "\ufffd" for char in text) for name, text in rows.items()
    }
    return "".join(column(f"  {name:9}", text) + "\n" for name, text in printable.items() if text)


def _observation_part(part: Mapping[str, Any]) -> str:
    """Describe a part of an observation: its key, its shape and its kind."""
    if part["kind"] == "categories":
        return f"{part['key']} ({' + '.join(map(str, part['sizes']))} categories)"
    return f"{part['key']} ({' x '.join(map(str, part['shape']))} {_KINDS[part['kind']]})"


def _action_part(part: Mapping[str, Any]) -> str:
    """Describe a part of an action: its name, and its choices or the shape of its numbers."""
    name = name_of(part["path"]) or "action"
    if part["kind"] == "numbers":
        return f"{name} ({' x '.join(map(str, part['shape'])) or '1'} numbers)"
    return f"{name} ({' + '.join(map(str, part['sizes']))} choices)"


def _map(sensor: Mapping[str, Any]) -> str:
    return f"{sensor['extent']} x {sensor['extent']} cells of {sensor['cell']:g} m: {', '.join(sensor['types'])}"


def _training(record: Mapping[str, Any]) -> str:
    """Describe a training from its record; leave out numbers that the record does not have.

    For example, ``seed 1, 200,000 steps, 85 s, pass rate 0.95 in its last episodes``.
    """
    window = record.get("window")
    # Without episodes there is no pass rate.
    values = {**(window if isinstance(window, dict) and window.get("episodes") else {}), **record}
    wordings: tuple[tuple[str, Callable[[Any], str]], ...] = (
        ("seed", "seed {}".format),
        ("steps", "{:,} steps".format),
        ("seconds", "{:,.0f} s".format),
        ("pass_rate", lambda rate: f"pass rate {share(rate)} in its last episodes"),
    )
    return ", ".join(wording(values[key]) for key, wording in wordings if isinstance(values.get(key), (int, float)))


def _best_policy(record: Mapping[str, Any]) -> str:
    """Describe the best policy, which the training kept; empty if the record does not name it."""
    best = record.get("best")
    if not isinstance(best, dict) or not isinstance(best.get("pass_rate"), (int, float)):
        return ""
    # The best of many windows is a lucky one.
    unconfirmed = ", not confirmed: in fresh episodes the rate is lower as a rule"
    steps, confirmed = best.get("steps"), ", confirmed in fresh episodes" if best.get("confirmed") else unconfirmed
    after = f", after {steps:,} steps" if isinstance(steps, int) else ""
    return f"the best policy, pass rate {share(best['pass_rate'])} in its window{after}{confirmed}"


def _initial_policy(record: Mapping[str, Any]) -> str:
    """Describe the policy that the training began with; empty if it began with random weights."""
    initial = record.get("initial")
    if not isinstance(initial, dict):
        return ""
    weights, level, variant = (str(initial.get(key)) for key in ("weights", "level", "variant"))
    return f"it began with the weights of another policy, for {level} {variant} (hash {weights[:12]})"


def _search(record: Mapping[str, Any]) -> str:
    """Describe the result of the training's search for demonstrations; empty if there was no search."""
    search = record.get("search")
    lengths = search.get("lengths") if isinstance(search, dict) else None
    if not isinstance(lengths, list) or not all(type(length) is int for length in lengths):
        return ""
    demonstrations = f"{len(lengths)} way{'s' * (len(lengths) != 1)} to meet the spec"
    return f"{demonstrations}, the shortest of {min(lengths)} steps" if lengths else "no way to meet the spec was found"


def _demonstrations(record: Mapping[str, Any]) -> str:
    """Describe the demonstrations that the agent imitated; empty if it learned without demonstrations."""
    imitated = record.get("imitated")
    if not isinstance(imitated, dict) or not all(type(imitated.get(key)) is int for key in ("episodes", "decisions")):
        return ""
    demonstrations = f"{imitated['episodes']} demonstration{'s' * (imitated['episodes'] != 1)}"
    players = imitated.get("players")
    by = f", by {' and '.join(map(str, players))}" if isinstance(players, list) and players else ""
    return f"{demonstrations} of {imitated['decisions']:,} decisions{by}"
