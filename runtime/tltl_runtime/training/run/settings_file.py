"""Read the TOML of settings: the known keys, and the valid values of each."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from math import isfinite
from typing import Any, Final, get_args

from tltl_runtime.policies.network import MAX_KERNEL, MAX_LAYERS, MAX_STRIDE, MAX_WIDTH, Activation
from tltl_runtime.support.suggestion import MOST_SUGGESTIONS, suggestion
from tltl_runtime.support.toml_tree import Entry, Tree, read_tree
from tltl_runtime.training.run.choices import EntropySchedule, Method, PenaltySchedule, Pool
from tltlc.api import Diagnostic, SourceFile, TltlError, monitors, record


@record
class NumberSetting:
    """A finite number in [low, high], or in (low, high] if ``open``."""

    low: float
    high: float
    open: bool = False

    def read(self, value: object) -> float | None:
        """Return the number, or None if it is invalid."""
        if not isinstance(value, (int, float)) or isinstance(value, bool) or not isfinite(value):
            return None
        return float(value) if self.low <= value <= self.high and not (self.open and value == self.low) else None

    def __str__(self) -> str:
        low, high = f"{self.low:g}", f"{self.high:,.0f}"
        return f"a number above {low}, and {high} at most" if self.open else f"a number from {low} to {high}"


@record
class Whole:
    """A whole number in [low, high]."""

    low: int
    high: int

    def read(self, value: object) -> int | None:
        """Return the number, or None if it is invalid."""
        return value if type(value) is int and self.low <= value <= self.high else None

    def __str__(self) -> str:
        return f"a whole number from {self.low:,} to {self.high:,}"


@record
class Wholes:
    """A list of one to ``most`` whole numbers, each in the range of ``each``."""

    each: Whole
    most: int

    def read(self, value: object) -> tuple[int, ...] | None:
        """Return the numbers, or None if they are invalid."""
        good = isinstance(value, list) and 1 <= len(value) <= self.most
        return tuple(value) if good and all(self.each.read(item) is not None for item in value) else None  # type: ignore[attr-defined, arg-type]

    def __str__(self) -> str:
        return f"a list of 1 to {self.most} whole numbers from {self.each.low:,} to {self.each.high:,}"


@record
class OneOf:
    """One of a few texts."""

    words: tuple[str, ...]

    def read(self, value: object) -> str | None:
        """Return the text, or None if it is invalid."""
        return value if isinstance(value, str) and value in self.words else None

    def __str__(self) -> str:
        return "one of " + ", ".join(f'"{word}"' for word in self.words)


@record
class TextSetting:
    """A text that matches the regular expression ``pattern``; messages describe it as ``what``."""

    pattern: str
    what: str

    def read(self, value: object) -> str | None:
        """Return the text, or None if it is invalid."""
        return value if isinstance(value, str) and re.fullmatch(self.pattern, value) else None

    def __str__(self) -> str:
        return self.what


Kind = NumberSetting | Whole | Wholes | OneOf | TextSetting

_CLASS: Final = TextSetting(r"[A-Za-z_][\w.]*(:[A-Za-z_][\w.]*)?", 'a class, e.g. "package.module:Class"')

KINDS: Final[Mapping[str, Mapping[str, Kind]]] = {
    "": {
        "method": OneOf(get_args(Method)),
        "device": TextSetting(r"cpu|cuda(:\d{1,2})?", 'a device: "cpu", "cuda" or "cuda:0"'),
        "threads": Whole(1, 1024),
        "checkpoint_s": NumberSetting(0.0, 86_400.0),
    },
    "ppo": {
        "learning_rate": NumberSetting(0.0, 1.0, open=True),
        "entropy": NumberSetting(0.0, 10.0),
        "entropy_schedule": OneOf(get_args(EntropySchedule)),
        "sharpening": NumberSetting(1.0, 100.0),
        "clip": NumberSetting(0.0, 10.0, open=True),
        "lam": NumberSetting(0.0, 1.0),
        "gamma": NumberSetting(0.0, 1.0, open=True),
        "epochs": Whole(1, 1_000),
        "minibatches": Whole(1, 100_000),
        "value_loss": NumberSetting(0.0, 1_000.0),
        "max_gradient": NumberSetting(0.0, 1_000_000.0, open=True),
        "warm_up": Whole(0, 100_000),
    },
    "rollout": {
        "envs": Whole(1, 100_000),
        "steps": Whole(2, 100_000),
        "workers": Whole(0, 10_000),
        "pool": OneOf(get_args(Pool)),
    },
    "network": {
        "hidden": Wholes(Whole(1, MAX_WIDTH), MAX_LAYERS),
        "activation": OneOf(get_args(Activation)),
        "channels": Wholes(Whole(1, MAX_WIDTH), MAX_LAYERS),
        "kernel": Whole(1, MAX_KERNEL),
        "stride": Whole(1, MAX_STRIDE),
    },
    "exploration": {
        "ways": Whole(0, 1_000),
        "steps": Whole(1, 10**9),
        "parts": Whole(1, 1_000),
        "imitation": Whole(0, 100),
    },
    "imitation": {
        "demonstrations": Whole(1, 10_000),
        "cloning": NumberSetting(0.0, 1.0),
        "encoding": Whole(1, MAX_WIDTH),
        "discriminator_rate": NumberSetting(0.0, 1.0, open=True),
        "gradient_penalty": NumberSetting(0.0, 10_000.0),
        "strength": NumberSetting(0.0, 1_000.0),
        "terminal": NumberSetting(0.0, 1_000.0),
    },
    "reward": {
        "mode": OneOf(monitors.MODES),
        "termination": OneOf(get_args(monitors.Termination)),
        "terminal_penalty": OneOf(get_args(monitors.TerminalPenalty)),
        "penalty_schedule": OneOf(get_args(PenaltySchedule)),
    },
    "stop": {
        "windows": Whole(1, 1_000),
        "episodes": Whole(1, 100_000),
        "confirmation": Whole(1, 100_000),
        "steps": Whole(1, 10**15),
        "minutes": NumberSetting(0.0, 1_000_000.0),
    },
    "classes": {"runner": _CLASS, "algorithm": _CLASS},
}
"""The kinds of values, by table and key.  The table ``""`` has the keys before the first table."""

_TOP: Final = "at the top, above the first `[...]`"
_HELP: Final = 'values are written as in `envs = 32` and `device = "cpu"`'


def read_values(source: SourceFile) -> dict[str, dict[str, Any]]:
    """Return the values of a settings text, by table and key.

    Raises TltlError with all errors: TLT0860, TLT0861, TLT0862.
    """
    log: list[Diagnostic] = []
    values: dict[str, dict[str, Any]] = {"": {}}
    for name, entry in read_tree(source, "TLT0860", _HELP).items():
        if name in KINDS[""]:
            _read("", name, entry, values[""], log)
        elif name not in KINDS:
            title = f"there is no setting `{name}`"
            known = [*KINDS[""], *(table for table in KINDS if table)]
            log.append(Diagnostic("TLT0861", title, (entry.label,), _home(name) or _like(name, known, log)))
        elif not isinstance(entry.value, dict):
            log.append(_wrong(entry, name, f"a table: a line `[{name}]` with its keys below"))
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
            log.append(Diagnostic("TLT0861", title, (entry.label,), _home(key) or _like(key, KINDS[table], log)))
    return values


def _read(table: str, key: str, entry: Entry, values: dict[str, Any], log: list[Diagnostic]) -> None:
    kind = KINDS[table][key]
    value = kind.read(entry.value)
    if value is None:
        log.append(_wrong(entry, key, str(kind)))
    else:
        values[key] = value


def _like(key: str, known: Iterable[str], log: list[Diagnostic]) -> str | None:
    """Suggest a similar setting, or None.

    With too many errors there are no suggestions, because each takes time.
    """
    return suggestion(key, known) if len(log) < MOST_SUGGESTIONS else None


def _home(key: str) -> str | None:
    """Return where a key in the wrong table belongs, or None for an unknown key."""
    places = [f"under `[{table}]`" if table else _TOP for table, kinds in KINDS.items() if key in kinds]
    return f"it belongs {' or '.join(places)}" if places else None


def _wrong(entry: Entry, key: str, expected: str) -> Diagnostic:
    return Diagnostic("TLT0862", f"wrong value for `{key}`", (entry.label,), f"expected {expected}")
