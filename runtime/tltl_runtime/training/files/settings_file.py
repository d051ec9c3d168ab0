"""Read the settings of a training from TOML, and check their keys and values."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from math import isfinite
from typing import Any, Final, get_args

from tltl_runtime.policies.network import MAX_KERNEL, MAX_LAYERS, MAX_STRIDE, MAX_WIDTH, Activation
from tltl_runtime.support.suggestion import MOST_SUGGESTIONS, suggestion
from tltl_runtime.support.toml_tree import Entry, Tree, read_tree
from tltl_runtime.training.files.choices import EntropySchedule, Method, PenaltySchedule, Pool
from tltlc.api import Diagnostic, SourceFile, TltlError, monitors, record


@record
class NumberSetting:
    """A setting that is a finite number in [low, high], or in (low, high] if ``open``."""

    low: float
    high: float
    open: bool = False

    def read(self, value: object) -> float | None:
        """Return ``value`` as a float; None if it is not a finite number in the range."""
        if not isinstance(value, (int, float)) or isinstance(value, bool) or not isfinite(value):
            return None
        return float(value) if self.low <= value <= self.high and not (self.open and value == self.low) else None

    def __str__(self) -> str:
        low, high = f"{self.low:g}", f"{self.high:,.0f}"
        return f"a number above {low} and at most {high}" if self.open else f"a number from {low} to {high}"


@record
class IntegerSetting:
    """A setting that is an integer in [low, high]."""

    low: int
    high: int

    def read(self, value: object) -> int | None:
        """Return ``value``, or None if it is not an integer in the range."""
        return value if type(value) is int and self.low <= value <= self.high else None

    def __str__(self) -> str:
        return f"a whole number from {self.low:,} to {self.high:,}"


@record
class IntegerListSetting:
    """A setting that is a list of 1 to ``max_length`` integers, each in the range of ``item``."""

    item: IntegerSetting
    max_length: int

    def read(self, value: object) -> tuple[int, ...] | None:
        """Return the list as a tuple; None if ``value`` is not such a list."""
        is_list = isinstance(value, list) and 1 <= len(value) <= self.max_length
        return tuple(value) if is_list and all(self.item.read(number) is not None for number in value) else None  # type: ignore[attr-defined, arg-type]

    def __str__(self) -> str:
        return f"a list of 1 to {self.max_length} whole numbers from {self.item.low:,} to {self.item.high:,}"


@record
class ChoiceSetting:
    """A setting that is one of the texts ``words``."""

    words: tuple[str, ...]

    def read(self, value: object) -> str | None:
        """Return ``value``, or None if it is not one of the texts."""
        return value if isinstance(value, str) and value in self.words else None

    def __str__(self) -> str:
        return "one of " + ", ".join(f'"{word}"' for word in self.words)


@record
class TextSetting:
    """A setting that is a text and matches the regular expression ``pattern``.

    ``description`` says in messages which texts are valid.
    """

    pattern: str
    description: str

    def read(self, value: object) -> str | None:
        """Return ``value``, or None if it is not a text that matches ``pattern``."""
        return value if isinstance(value, str) and re.fullmatch(self.pattern, value) else None

    def __str__(self) -> str:
        return self.description


Kind = NumberSetting | IntegerSetting | IntegerListSetting | ChoiceSetting | TextSetting

_CLASS: Final = TextSetting(r"[A-Za-z_][\w.]*(:[A-Za-z_][\w.]*)?", 'a class, e.g. "package.module:Class"')

KINDS: Final[Mapping[str, Mapping[str, Kind]]] = {
    "": {
        "method": ChoiceSetting(get_args(Method)),
        "device": TextSetting(r"cpu|cuda(:\d{1,2})?", 'a device: "cpu", "cuda" or "cuda:0"'),
        "threads": IntegerSetting(1, 1024),
        "checkpoint_s": NumberSetting(0.0, 86_400.0),
    },
    "ppo": {
        "learning_rate": NumberSetting(0.0, 1.0, open=True),
        "entropy": NumberSetting(0.0, 10.0),
        "entropy_schedule": ChoiceSetting(get_args(EntropySchedule)),
        "sharpening": NumberSetting(1.0, 100.0),
        "clip": NumberSetting(0.0, 10.0, open=True),
        "lam": NumberSetting(0.0, 1.0),
        "gamma": NumberSetting(0.0, 1.0, open=True),
        "epochs": IntegerSetting(1, 1_000),
        "minibatches": IntegerSetting(1, 100_000),
        "value_loss": NumberSetting(0.0, 1_000.0),
        "max_gradient": NumberSetting(0.0, 1_000_000.0, open=True),
        "warm_up": IntegerSetting(0, 100_000),
    },
    "rollout": {
        "envs": IntegerSetting(1, 100_000),
        "steps": IntegerSetting(2, 100_000),
        "workers": IntegerSetting(0, 10_000),
        "pool": ChoiceSetting(get_args(Pool)),
    },
    "network": {
        "hidden": IntegerListSetting(IntegerSetting(1, MAX_WIDTH), MAX_LAYERS),
        "activation": ChoiceSetting(get_args(Activation)),
        "channels": IntegerListSetting(IntegerSetting(1, MAX_WIDTH), MAX_LAYERS),
        "kernel": IntegerSetting(1, MAX_KERNEL),
        "stride": IntegerSetting(1, MAX_STRIDE),
    },
    "exploration": {
        "ways": IntegerSetting(0, 1_000),
        "steps": IntegerSetting(1, 10**9),
        "parts": IntegerSetting(1, 1_000),
        "imitation": IntegerSetting(0, 100),
    },
    "imitation": {
        "demonstrations": IntegerSetting(1, 10_000),
        "cloning": NumberSetting(0.0, 1.0),
        "encoding": IntegerSetting(1, MAX_WIDTH),
        "discriminator_rate": NumberSetting(0.0, 1.0, open=True),
        "gradient_penalty": NumberSetting(0.0, 10_000.0),
        "strength": NumberSetting(0.0, 1_000.0),
        "terminal": NumberSetting(0.0, 1_000.0),
    },
    "reward": {
        "mode": ChoiceSetting(monitors.MODES),
        "termination": ChoiceSetting(get_args(monitors.Termination)),
        "terminal_penalty": ChoiceSetting(get_args(monitors.TerminalPenalty)),
        "penalty_schedule": ChoiceSetting(get_args(PenaltySchedule)),
    },
    "stop": {
        "windows": IntegerSetting(1, 1_000),
        "episodes": IntegerSetting(1, 100_000),
        "confirmation": IntegerSetting(1, 100_000),
        "steps": IntegerSetting(1, 10**15),
        "minutes": NumberSetting(0.0, 1_000_000.0),
    },
    "classes": {"runner": _CLASS, "algorithm": _CLASS},
}
"""The valid values of each setting, by table and key. The table ``""`` has the keys above the first table."""

_TOP: Final = "at the top, above the first `[...]`"
_HELP: Final = 'write values as in `envs = 32` and `device = "cpu"`'


def read_values(source: SourceFile) -> dict[str, dict[str, Any]]:
    """Return the values in a settings file, by table and key; settings that it leaves out are missing.

    The table ``""`` has the keys above the first table. Raises TltlError with all errors: TLT0860,
    not TOML; TLT0861, an unknown key; TLT0862, an invalid value.
    """
    log: list[Diagnostic] = []
    values: dict[str, dict[str, Any]] = {"": {}}
    for name, entry in read_tree(source, "TLT0860", _HELP).items():
        if name in KINDS[""]:
            _read("", name, entry, values[""], log)
        elif name not in KINDS:
            title = f"there is no setting `{name}`"
            known = [*KINDS[""], *(table for table in KINDS if table)]
            log.append(
                Diagnostic("TLT0861", title, (entry.label,), _place_of_key(name) or _suggestion(name, known, log))
            )
        elif not isinstance(entry.value, dict):
            log.append(_value_error(entry, name, f"a table: a line `[{name}]` with its keys below"))
        else:
            values[name] = _table(name, entry.value, log)
    if log:
        raise TltlError(log)
    return values


def _table(table: str, tree: Tree, log: list[Diagnostic]) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for key, entry in tree.items():
        if key in KINDS[table]:
            _read(table, key, entry, values, log)
        else:
            title = f"there is no setting `{key}` in `[{table}]`"
            log.append(
                Diagnostic("TLT0861", title, (entry.label,), _place_of_key(key) or _suggestion(key, KINDS[table], log))
            )
    return values


def _read(table: str, key: str, entry: Entry, values: dict[str, Any], log: list[Diagnostic]) -> None:
    kind = KINDS[table][key]
    value = kind.read(entry.value)
    if value is None:
        log.append(_value_error(entry, key, str(kind)))
    else:
        values[key] = value


def _suggestion(key: str, known: Iterable[str], log: list[Diagnostic]) -> str | None:
    """Return a hint for the unknown setting ``key``: a similar name, or else the names in ``known``.

    Return None if ``log`` already has many errors, because each search takes time.
    """
    return suggestion(key, known) if len(log) < MOST_SUGGESTIONS else None


def _place_of_key(key: str) -> str | None:
    """Return a hint that says to which table ``key`` belongs; None if no table has such a key."""
    places = [f"under `[{table}]`" if table else _TOP for table, kinds in KINDS.items() if key in kinds]
    return f"it belongs {' or '.join(places)}" if places else None


def _value_error(entry: Entry, key: str, expected: str) -> Diagnostic:
    return Diagnostic("TLT0862", f"wrong value for `{key}`", (entry.label,), f"expected {expected}")
