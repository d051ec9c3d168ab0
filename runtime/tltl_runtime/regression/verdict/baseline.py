"""The baseline of a suite: what its policies did on the levels as they were designed, in a file beside the suite."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from shlex import join
from typing import Final

from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.suite.suite import SHIPPED, Suite, baseline_path
from tltl_runtime.regression.verdict.verdict import FIGURES
from tltl_runtime.stealth.levels.made_for import shown
from tltl_runtime.support.load_errors import Refusals
from tltl_runtime.support.record_json import RecordJsonError, from_json, to_json
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import EMPTY, record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import read_bytes
from tltlc.io.json_text import loads
from tltlc.io.limits import REPORT
from tltlc.io.resources import bounded
from tltlc.io.writing import write_file

FORMAT: Final = "tltl-baseline"
VERSION: Final = 3
MAX_BYTES: Final = REPORT.size

_ROUNDING: Final = 1e-6
"""By which a sum of rewards may exceed what it can be."""

_REFUSALS: Final = Refusals(
    "a baseline", "TLT0900", "TLT0901", "TLT0902", again="record it again with `tltlc baseline`"
)


@record
class Identity:
    """What was played: a policy on a level in a variant, judged by a spec, with the seed of the episodes.

    ``level`` and ``spec`` are names; the hashes are those of :mod:`tltl_runtime.policies.identity`, and ``policy`` is
    the SHA-256 of its file.  ``files`` are those that the level was made of, with their SHA-256; ``place`` is the
    case's.
    """

    level: str
    variant: str
    spec: str
    policy: str
    seed: int
    level_hash: str
    spec_hash: str
    files: tuple[tuple[str, str], ...]
    versions: Mapping[str, str]
    place: str = ""


@record
class Reference:
    """What was played, the accounts of its episodes, from number 0 on, and the texts of the files that its level was
    made of, by their names in ``played.files``.  ``sources`` is the hash of the code that played, empty if not known.
    """

    played: Identity
    accounts: tuple[Account, ...]
    texts: tuple[tuple[str, str], ...] = ()
    sources: str = ""


def write_baseline(path: Path, references: tuple[Reference, ...]) -> None:
    """Write the baseline of a suite; raises TltlError, TLT0005."""
    written = tuple(_Written(each.played, each.accounts, each.sources) for each in references)
    document = _json({"format": FORMAT, "version": VERSION, "references": to_json(written)})
    # A line for each episode and for each line of a text, so that what a change of it changes can be read.
    episodes = document.removesuffix("}").replace('{"index":', '\n{"index":')
    texts = {text_sha256(text): text.split("\n") for each in references for _, text in each.texts}
    lines = ",\n".join(_lines(sha256, each) for sha256, each in texts.items())
    write_file(path, f'{episodes},\n"texts":{{{lines}}}}}\n', "name another place with --output", over_inputs=True)


@bounded()
def read_baseline(path: Path) -> tuple[Reference, ...]:
    """The baseline in a file.

    Raises:
        TltlError: TLT0001 it cannot be read; TLT0900 it is no baseline; TLT0901 of another version; TLT0902 something
            in it is not as it must be.
    """
    name = str(path)
    try:
        document = loads(read_bytes(path, name, MAX_BYTES), REPORT)
    except (ValueError, RecursionError) as error:
        raise _REFUSALS.unreadable(name, f"it is not JSON: {error!s:.60}") from None
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise _REFUSALS.unreadable(name, "it is something else")
    _REFUSALS.check_version(name, document.get("version"), VERSION)
    try:
        read = from_json(_Document, document, "baseline")
    except (RecordJsonError, RecursionError) as error:
        raise _REFUSALS.broken(name, str(error)) from None
    texts = {sha256: "\n".join(lines) for sha256, lines in read.texts.items()}
    for sha256, text in texts.items():
        if text_sha256(text) != sha256:
            raise _REFUSALS.broken(name, f"baseline.texts: what is called `{sha256:.12}` has another SHA-256")
    for row, each in enumerate(read.references):
        where = f"baseline.references[{row}].accounts"
        # Episodes are compared by their place, and a mean of none is no figure.
        if not each.accounts or any(account.index != place for place, account in enumerate(each.accounts)):
            raise _REFUSALS.broken(name, f"{where}: the episodes must be there from number 0 on, without a gap")
        for account in each.accounts:
            for flaw in _flaws(account):
                raise _REFUSALS.broken(name, f"{where}[{account.index}]: {flaw}")
    return tuple(
        Reference(each.played, each.accounts, _texts(each.played, texts), each.sources) for each in read.references
    )


def _texts(played: Identity, texts: Mapping[str, str]) -> tuple[tuple[str, str], ...]:
    """The texts of what was played, those that there are."""
    return tuple((name, texts[sha256]) for name, sha256 in played.files if sha256 in texts)


def _lines(sha256: str, lines: Sequence[str]) -> str:
    within = ",\n".join(map(_json, lines))
    return f'"{sha256}":[\n{within}]'


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def text_sha256(text: str) -> str:
    """The SHA-256 of a text, in hexadecimal, as the files of a level have it."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def _flaws(account: Account) -> Iterator[str]:
    """What no episode can have come to."""
    for key in ("arrivals", "way"):
        if not getattr(account, key):
            yield f"`{key}` is empty, and begins where the player does"
    if account.steps < 1:
        yield f"`steps` is {account.steps}, and an episode has one at least"
    if min(_states(account)) < 0:
        yield f"it has the state {min(_states(account))}, and states are counted from 0"
    for key, (least, most) in FIGURES.items():
        value = getattr(account, key)
        if not least - _ROUNDING <= value <= most + _ROUNDING:
            yield f"`{key}` is {value:g}, and a number from {least:g} to {most:g} was expected"


def _states(account: Account) -> Iterator[int]:
    """The states of the automaton that an account speaks of."""
    yield account.unmet
    yield from (arrival.state for arrival in account.arrivals)
    yield from (state for *_, state, _ in account.way)


def baseline_of(suite: Suite) -> tuple[Reference, ...]:
    """The baseline of a suite; TLT0903 where there is none, and errors as of :func:`read_baseline`."""
    if _is_missing(suite.baseline):
        title = f"the suite `{shown(suite.path)}` has no baseline: there is no `{shown(suite.baseline)}`"
        raise TltlError([Diagnostic("TLT0903", title, help=f"record it: {baseline_command(suite)}")])
    return read_baseline(suite.baseline)


def _is_missing(path: Path) -> bool:
    """Whether there is no such file; of one that cannot be looked at, reading tells why."""
    try:
        path.stat()
    except (OSError, ValueError) as error:
        return isinstance(error, (FileNotFoundError, NotADirectoryError))
    return False


def reference_of(references: tuple[Reference, ...], wanted: Identity, suite: Suite) -> Reference:
    """What the baseline has of the same level, variant, spec, policy and seed; the level may be another one by now.

    Raises:
        TltlError: TLT0903, there is none.
    """
    named = [each for each in references if _same(each.played, wanted, ("level", "variant"))]
    there = [each for each in named if each.played.place == wanted.place]
    known = [each for each in there if _same(each.played, wanted, ("policy", "spec_hash", "seed"))]
    if known:
        return known[0]
    # Where there is another level of that name its place tells which one is meant.
    level = wanted.place if named and not there and wanted.place else wanted.level
    title = f"the baseline has no figures of `{level}:{wanted.variant}`"
    if there:
        names = {"policy": "policy", "spec_hash": "spec", "seed": "seed"}
        other = [what for name, what in names.items() if not _same(there[0].played, wanted, (name,))]
        title += f" with this {other[0]}"
    raise TltlError([Diagnostic("TLT0903", title, help=f"record it: {baseline_command(suite)}")])


def check_states(reference: Reference, fspa: Fspa, suite: Suite) -> None:
    """Raise TltlError, TLT0902, where an episode was in a state that its spec's automaton does not have."""
    count, played = len(fspa.states), reference.played
    for account in reference.accounts:
        if (state := max(_states(account))) >= count:
            where = f"episode {account.index} of `{played.level}:{played.variant}`"
            why = f"{where} has the state {state}, and those of `{played.spec}` are 0 to {count - 1}"
            raise _REFUSALS.broken(str(suite.baseline), why)


def written_to(suite: Path) -> Path:
    """Where `tltlc baseline` writes, unless it is told: of the suite that comes with the package not into this."""
    return Path("shipped.baseline.json") if suite == SHIPPED else baseline_path(suite)


def baseline_command(suite: Suite) -> str:
    """What records the baseline of a suite, to be pasted."""
    words = ["tltlc", "baseline", *([] if suite.path == SHIPPED else [shown(suite.path)])]
    if suite.baseline != written_to(suite.path):
        words += ["--output", shown(suite.baseline)]
    return join(words)


@record
class _Written:
    """A reference without its texts, which stand beside all of them: levels and variants share files."""

    played: Identity
    accounts: tuple[Account, ...]
    sources: str = ""


@record
class _Document:
    format: str
    version: int
    references: tuple[_Written, ...]
    texts: Mapping[str, tuple[str, ...]] = EMPTY
    """Lines by the SHA-256 of the whole."""


def _same(one: Identity, other: Identity, names: tuple[str, ...]) -> bool:
    return all(getattr(one, name) == getattr(other, name) for name in names)
