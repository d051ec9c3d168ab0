"""Read and write policy files.

The format is safetensors; ``docs/policy-file.md`` describes it. Nothing in a file is executed.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Collection
from math import prod
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from safetensors import SafetensorError
from safetensors.numpy import load, save

from tltl_runtime.game.registry import STEALTH, game_named
from tltl_runtime.game.sensors import Sensors, sensor_shapes
from tltl_runtime.policies.actor import weight_shapes
from tltl_runtime.policies.card import Card
from tltl_runtime.policies.network import Network
from tltl_runtime.policies.policy import Policy, weight_dtype
from tltl_runtime.policies.spaces.encoder_plan import NORMALIZER, space_weight_shapes
from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.spec.automaton_observation import automaton_entries
from tltl_runtime.support.load_errors import LoadErrors
from tltl_runtime.support.record_json import RecordJsonError, from_json, to_json
from tltlc.api import Diagnostic, Fspa, TltlError, compiler, fileio

SUFFIX: Final = ".safetensors"
FORMAT: Final = "tltl-policy"
VERSION: Final = 1
MAX_BYTES: Final = fileio.limits.POLICY.size
"""The maximum size of a file: 64 MiB, or about thirty million weights."""
_RECORD_BYTES: Final = 1 << 20
"""The number of bytes that :func:`check_size` assumes for the card without the spec's automaton."""

_PREFIX: Final = "actor."
_DEVIATION: Final = f"{_PREFIX}{NORMALIZER}deviation"
_DTYPES: Final = {np.float16: "F16", np.float32: "F32"}
_KEY: Final = "card"
"""The only metadata key of a file.

With several keys, their order could differ, and then the files of equal policies would differ.
"""

_ERRORS: Final = LoadErrors("a", "policy", "TLT0840", "TLT0841", "TLT0842", again="train the policy again")
_HASH: Final = re.compile(r"[0-9a-f]{64}\Z")


def write_policy(path: str | os.PathLike[str], policy: Policy, advice: str = "name another place") -> None:
    """Write a policy to a file; even a power failure leaves no partial file.

    Equal policies give equal bytes. ``advice`` is the help of the error if the system refuses to
    write.

    Raises:
        TltlError: TLT0005, the system refuses to write; TLT0862, the file would be larger than
            :data:`MAX_BYTES`.
        ValueError: the record of the training is not JSON data.
    """
    fileio.write_file(Path(path), to_bytes(policy), advice, durable=True, over_inputs=True)


@fileio.resource_limits()
def read_policy(path: str | os.PathLike[str]) -> Policy:
    """Read a policy from a file.

    Raises:
        TltlError: TLT0001, the file cannot be read; TLT0840, it is not a policy, or is damaged;
            TLT0841, it has another version; TLT0842, something in it is invalid; TLT0601 to
            TLT0604, the spec's automaton in it is invalid.
    """
    name = os.fspath(path)
    return from_bytes(fileio.read_bytes(path, name, MAX_BYTES), name)


def to_bytes(policy: Policy) -> bytes:
    """Return the bytes that :func:`write_policy` writes.

    Raises:
        TltlError: TLT0862, there are more than :data:`MAX_BYTES`.
        ValueError: the record of the training is not JSON data.
    """
    text = json.dumps(card_json(policy.card), ensure_ascii=False, allow_nan=False)
    weights = {f"{_PREFIX}{name}": weight for name, weight in policy.weights().items()}
    data = save(weights, {_KEY: text})
    if len(data) > MAX_BYTES:
        raise _too_large(len(data))
    return data


def check_size(network: Network, fspa: Fspa, sensors: Sensors, spaces: SpaceLayouts | None = None) -> None:
    """Raise TltlError, TLT0862, if a policy with this network cannot be used or stored.

    It cannot be used if its convolutions do not fit the map that it observes. It cannot be stored
    if it is too large for a file. ``spaces`` describe the observation; if they are None,
    ``sensors`` and the automaton ``fspa`` do.
    """
    # Encoded twice: the card is a JSON string in the JSON header of the file.
    text = json.dumps(json.dumps(compiler.encode_artefact(fspa), ensure_ascii=False), ensure_ascii=False)
    try:
        if spaces is not None:
            shapes = space_weight_shapes(network, spaces)
        else:
            shapes = weight_shapes(network, _observation_shapes(fspa, sensors), game_named(STEALTH).branches)
    except ValueError as error:
        help_ = "give a smaller `stride` or a larger `kernel`"
        raise TltlError([Diagnostic("TLT0862", f"`network`: {error}", help=help_)]) from None
    size = sum(prod(shape) * np.dtype(weight_dtype(name)).itemsize for name, shape in shapes.items())
    size += len(text.encode()) + _RECORD_BYTES
    if size > MAX_BYTES:
        raise _too_large(size)


def card_json(card: Card) -> dict[str, Any]:
    """Return the card as JSON data; ``artefact``, the spec's automaton as JSON, replaces ``fspa``."""
    document: dict[str, Any] = {"format": FORMAT, "version": VERSION}
    absent = {"fspa"} if card.spaces else {"fspa", "spaces"}
    document |= {name: to_json(getattr(card, name)) for name in Card.__match_args__ if name not in absent}
    return document | {"artefact": compiler.encode_artefact(card.fspa)}


def card_weight_shapes(card: Card) -> dict[str, tuple[int, ...]]:
    """Return the shapes of the weights of the network that a card describes, by name.

    Raises ValueError if the convolutions do not fit a map.
    """
    if card.spaces is not None:
        return space_weight_shapes(card.network, card.spaces)
    return weight_shapes(card.network, dict(card.shapes), card.branches)


def from_bytes(data: bytes, name: str) -> Policy:
    """Parse the bytes of a policy file; messages call the file ``name``.

    Raises the errors of :func:`read_policy`, except TLT0001.
    """
    if len(data) > MAX_BYTES:
        raise _ERRORS.unreadable_error(name, f"it is larger than {MAX_BYTES >> 20} MiB")
    header = _header(data, name)
    card = _card(header, name)
    _check_tensors(header, card, name)
    return Policy(card, _weights(data, name))


def _too_large(size: int) -> TltlError:
    title = (
        f"`network` gives a policy of {-(-size >> 20)} MiB, but the file of a policy has at most {MAX_BYTES >> 20} MiB"
    )
    help_ = "give smaller `hidden` or `channels`, or a greater `stride`"
    return TltlError([Diagnostic("TLT0862", title, help=help_)])


# --- reading untrusted files ------------------------------------------------------------------------


def _header(data: bytes, name: str) -> dict[str, Any]:
    """Return the JSON header of a safetensors file; its length is in the first eight bytes of the file.

    Raises TltlError, TLT0840, if there is no valid header.
    """
    length = int.from_bytes(data[:8], "little")
    try:
        header = fileio.parse_json(data[8 : 8 + length], fileio.limits.ARTEFACT) if length <= len(data) - 8 else None
    except (ValueError, RecursionError):
        header = None
    if not isinstance(header, dict):
        raise _ERRORS.unreadable_error(name, "it is not a complete safetensors file")
    return header


def _card(header: dict[str, Any], name: str) -> Card:
    try:
        document = fileio.parse_json(header["__metadata__"][_KEY], fileio.limits.ARTEFACT)
    except (KeyError, TypeError):
        document = None
    except (ValueError, RecursionError):
        raise _ERRORS.broken_error(name, "its card is not JSON") from None
    if not isinstance(document, dict) or document.pop("format", None) != FORMAT:
        raise _ERRORS.unreadable_error(name, "it contains the weights of something else")
    _ERRORS.check_version(name, document.pop("version", None), VERSION)
    try:
        fspa = compiler.decode_artefact(document.pop("artefact", None), f"{name}/artefact")
        card = from_json(Card, document, "card", fspa=fspa)
    except (RecordJsonError, RecursionError) as error:
        raise _ERRORS.broken_error(name, str(error)) from None
    if wrong := _fault(card):
        raise _ERRORS.broken_error(name, wrong)
    return card


def _fault(card: Card) -> str | None:
    """Return what is wrong with a card whose fields have the right types; None if it is valid."""
    if not _HASH.match(card.level_hash):
        return "`card.level_hash` is not a hash"
    if card.spaces is not None:
        return _spaces_fault(card, card.spaces)
    shapes = dict(card.shapes)
    expected = _observation_shapes(card.fspa, card.sensors)
    if len(shapes) < len(card.shapes) or shapes != expected or not _are_sizes(shapes.values()):
        return "`card.shapes` are not those of its spec and its sensors"
    if not card.branches or min(card.branches) < 1 or sum(card.branches) > 1 << 16:
        return "`card.branches` are not the branches of an action"
    return None


def _spaces_fault(card: Card, spaces: SpaceLayouts) -> str | None:
    """Return what is wrong with a card whose field ``spaces`` is not None; None if it is valid."""
    if card.shapes != tuple(spaces.shapes.items()):
        return "`card.shapes` are not those of `card.spaces`"
    if card.branches:
        return "`card.branches` contradicts `card.spaces`"
    return None


def _are_sizes(shapes: Collection[tuple[int, ...]]) -> bool:
    """Whether every dimension of every shape is at least 1, and no shape has too many elements."""
    return min(map(min, shapes)) >= 1 and max(map(prod, shapes)) <= MAX_BYTES


def _observation_shapes(fspa: Fspa, sensors: Sensors) -> dict[str, tuple[int, ...]]:
    """Return the shapes of the parts of an observation, by key, for a spec and sensors."""
    return {"automaton": (len(automaton_entries(fspa)),), "progress": (1,), **sensor_shapes(sensors)}


def _check_tensors(header: dict[str, Any], card: Card, name: str) -> None:
    """Raise TltlError, TLT0842, unless the header lists exactly the weights of the card's network.

    The caller makes this check before it loads any weights.
    """
    try:
        shapes = card_weight_shapes(card)
    except ValueError as error:
        raise _ERRORS.broken_error(name, f"its card does not describe a network: {error}") from None
    expected = {f"{_PREFIX}{key}": list(shape) for key, shape in shapes.items()}
    stored = {key: entry for key, entry in header.items() if key != "__metadata__"}
    for key in sorted(expected.keys() | stored.keys()):
        if key not in stored:
            raise _ERRORS.broken_error(name, f"the tensor `{key}` is missing")
        if key not in expected:
            raise _ERRORS.broken_error(name, f"its network does not use the tensor `{key:.60}`")
        entry = stored[key] if isinstance(stored[key], dict) else {}
        dtype = _DTYPES[weight_dtype(key.removeprefix(_PREFIX))]
        if entry.get("dtype") != dtype or entry.get("shape") != expected[key]:
            is_ = f"{entry.get('dtype')!s:.20} of shape {entry.get('shape')!s:.40}"
            raise _ERRORS.broken_error(name, f"the tensor `{key}` is {is_}, not {dtype} of shape {expected[key]}")


def _weights(data: bytes, name: str) -> dict[str, NDArray[Any]]:
    try:
        weights = load(data)
    except (SafetensorError, ValueError):
        raise _ERRORS.unreadable_error(name, "its weights are cut off or damaged") from None
    for key, weight in weights.items():
        if not np.isfinite(weight).all():
            raise _ERRORS.broken_error(name, f"the tensor `{key}` has values that are not finite numbers")
        if key == _DEVIATION and not (weight > 0).all():
            raise _ERRORS.broken_error(name, f"the tensor `{key}` has values that are not above 0")
    return {key.removeprefix(_PREFIX): weight for key, weight in weights.items()}
