"""The baseline of a suite: the episodes that its policies once played, in a JSON file.

Regression tests compare new episodes with these.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from shlex import join
from typing import Final

from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.suite.suite import SHIPPED, Suite, baseline_path
from tltl_runtime.regression.verdict.verdict import FIGURES
from tltl_runtime.support.load_errors import LoadErrors
from tltl_runtime.support.path_text import path_text
from tltl_runtime.support.record_json import RecordJsonError, from_json, to_json
from tltlc.api import EMPTY, Diagnostic, Fspa, TltlError, fileio, record

FORMAT: Final = "tltl-baseline"
VERSION: Final = 3
MAX_BYTES: Final = fileio.limits.REPORT.size

_ROUNDING: Final = 1e-6
"""The rounding error by which a figure may leave its range."""

_REFUSALS: Final = LoadErrors(
    "a", "baseline", "TLT0900", "TLT0901", "TLT0902", again="record it again with `tltlc baseline`"
)


@record
class Identity:
    """What was played: policy, level, variant of the level, spec and seed of the episodes.

    ``level``, ``variant`` and ``spec`` are names. ``level_hash`` is from
    :meth:`~tltl_runtime.game.game.Game.level_hash`, ``spec_hash`` from
    :func:`~tltl_runtime.policies.identity.spec_hash`. ``policy`` is the SHA-256 of the policy's
    file. ``files`` are pairs: the name of a file that the level was loaded from, and its SHA-256.
    ``versions`` has the versions of the software that played, by name. ``place`` is the level's
    path relative to the suite, which distinguishes levels of the same name; it is empty for a
    level of the package.
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
    """The part of a baseline for one policy, level and spec: episodes to compare new ones with.

    ``played`` identifies what was played. ``episodes`` are in order, numbered from 0. ``texts`` are
    pairs: the name of one of the level's files, as in ``played.files``, and its text. ``sources``
    is the hash of the source code of tltlc that played, or empty if it is unknown.
    """

    played: Identity
    episodes: tuple[ExplainedEpisode, ...]
    texts: tuple[tuple[str, str], ...] = ()
    sources: str = ""


def write_baseline(path: Path, references: tuple[Reference, ...]) -> None:
    """Write the baseline of a suite to the file ``path``.

    Raises:
        TltlError: TLT0005, the file cannot be written.
    """
    references_without_texts = tuple(
        _StoredReference(reference.played, reference.episodes, reference.sources) for reference in references
    )
    document = _json({"format": FORMAT, "version": VERSION, "references": to_json(references_without_texts)})
    # Each episode and each line of a text gets its own line, so that diffs of the file are readable.
    references_text = document.removesuffix("}").replace('{"index":', '\n{"index":')
    texts = {text_sha256(text): text.split("\n") for reference in references for _, text in reference.texts}
    lines = ",\n".join(_lines(sha256, text_lines) for sha256, text_lines in texts.items())
    fileio.write_file(
        path, f'{references_text},\n"texts":{{{lines}}}}}\n', "name another place with --output", over_inputs=True
    )


@fileio.resource_limits()
def read_baseline(path: Path) -> tuple[Reference, ...]:
    """Read a baseline from a file.

    Raises:
        TltlError: TLT0001, the file cannot be read; TLT0900, it is not a baseline; TLT0901, it has
            another version; TLT0902, its content is invalid.
    """
    name = str(path)
    try:
        document = fileio.parse_json(fileio.read_bytes(path, name, MAX_BYTES), fileio.limits.REPORT)
    except (ValueError, RecursionError) as error:
        raise _REFUSALS.unreadable_error(name, f"it is not JSON: {error!s:.60}") from None
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise _REFUSALS.unreadable_error(name, "it is another kind of file")
    _REFUSALS.check_version(name, document.get("version"), VERSION)
    try:
        parsed = from_json(_BaselineDocument, document, "baseline")
    except (RecordJsonError, RecursionError) as error:
        raise _REFUSALS.broken_error(name, str(error)) from None
    texts = {sha256: "\n".join(lines) for sha256, lines in parsed.texts.items()}
    for sha256, text in texts.items():
        if text_sha256(text) != sha256:
            raise _REFUSALS.broken_error(name, f"baseline.texts: the text called `{sha256:.12}` has another SHA-256")
    for row, reference in enumerate(parsed.references):
        where = f"baseline.references[{row}].accounts"
        # Episodes are compared by index, and the mean of no episodes is undefined.
        if not reference.accounts or any(
            episode.summary.index != place for place, episode in enumerate(reference.accounts)
        ):
            raise _REFUSALS.broken_error(name, f"{where}: the episodes must be numbered from 0 on, without a gap")
        for episode in reference.accounts:
            for flaw in _flaws(episode):
                raise _REFUSALS.broken_error(name, f"{where}[{episode.summary.index}]: {flaw}")
    return tuple(
        Reference(reference.played, reference.accounts, _texts(reference.played, texts), reference.sources)
        for reference in parsed.references
    )


def _texts(played: Identity, texts: Mapping[str, str]) -> tuple[tuple[str, str], ...]:
    """Return pairs of name and text, one for each file in ``played.files`` whose text is known.

    ``texts`` maps the SHA-256 of each known text to the text.
    """
    return tuple((name, texts[sha256]) for name, sha256 in played.files if sha256 in texts)


def _lines(sha256: str, lines: Sequence[str]) -> str:
    items = ",\n".join(map(_json, lines))
    return f'"{sha256}":[\n{items}]'


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def text_sha256(text: str) -> str:
    """Return the SHA-256 of a text in UTF-8, in hexadecimal, as ``Identity.files`` has it for files."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def _flaws(episode: ExplainedEpisode) -> Iterator[str]:
    """Yield a message for each impossible value in an episode of a baseline, for example a negative state."""
    if not episode.arrivals:
        yield "`arrivals` is empty, but must begin with the start"
    elif not episode.way and episode.arrivals[0].place is not None:
        yield "`way` is empty, but must begin where the player begins"
    if episode.summary.seed is None:
        yield "`seed` is None, but a whole number was expected"
    if episode.summary.steps < 1:
        yield f"`steps` is {episode.summary.steps}, but an episode has at least one"
    if min(_states(episode)) < 0:
        yield f"it has the state {min(_states(episode))}, but states are counted from 0"
    for key, (least, most) in FIGURES.items():
        value = getattr(episode.summary, key)
        if not least - _ROUNDING <= value <= most + _ROUNDING:
            yield f"`{key}` is {value:g}, but a number from {least:g} to {most:g} was expected"


def _states(episode: ExplainedEpisode) -> Iterator[int]:
    """Yield the numbers of the automaton's states in an episode; some may repeat."""
    yield episode.summary.unmet
    yield from (arrival.state for arrival in episode.arrivals)
    yield from (state for *_, state, _ in episode.way)


def baseline_of(suite: Suite) -> tuple[Reference, ...]:
    """Read the baseline of a suite from its file, ``suite.baseline``.

    Raises:
        TltlError: TLT0903, there is no such file; the errors of :func:`read_baseline`.
    """
    if _is_missing(suite.baseline):
        title = f"the suite `{path_text(suite.path)}` has no baseline: there is no `{path_text(suite.baseline)}`"
        raise TltlError([Diagnostic("TLT0903", title, help=f"record it: {baseline_command(suite)}")])
    return read_baseline(suite.baseline)


def _is_missing(path: Path) -> bool:
    """Whether a file does not exist.

    False if it cannot be accessed: reading the file then reports why.
    """
    try:
        path.stat()
    except (OSError, ValueError) as error:
        return isinstance(error, (FileNotFoundError, NotADirectoryError))
    return False


def reference_of(references: tuple[Reference, ...], identity: Identity, suite: Suite) -> Reference:
    """Return the reference with the level, place, variant, policy, spec and seed of ``identity``.

    The level may have been edited since it was recorded: its hash and its files are not compared.
    The spec is compared by its hash. ``suite`` is for the help of the error.

    Raises:
        TltlError: TLT0903, the baseline has no such reference.
    """
    with_name = [reference for reference in references if _agree(reference.played, identity, ("level", "variant"))]
    with_place = [reference for reference in with_name if reference.played.place == identity.place]
    matches = [
        reference for reference in with_place if _agree(reference.played, identity, ("policy", "spec_hash", "seed"))
    ]
    if matches:
        return matches[0]
    # If the baseline knows this name only from another level, name the level by its place.
    level = identity.place if with_name and not with_place and identity.place else identity.level
    title = f"the baseline has no figures for `{level}:{identity.variant}`"
    if with_place:
        names = {"policy": "policy", "spec_hash": "spec", "seed": "seed"}
        differing = [word for name, word in names.items() if not _agree(with_place[0].played, identity, (name,))]
        title += f" with this {differing[0]}"
    raise TltlError([Diagnostic("TLT0903", title, help=f"record it: {baseline_command(suite)}")])


def check_states(reference: Reference, fspa: Fspa, suite: Suite) -> None:
    """Check that all states in the episodes of ``reference`` are states of the automaton ``fspa``.

    Raises:
        TltlError: TLT0902, an episode has a state that the automaton does not have.
    """
    count, played = len(fspa.states), reference.played
    for episode in reference.episodes:
        if (state := max(_states(episode))) >= count:
            where = f"episode {episode.summary.index} of `{played.level}:{played.variant}`"
            why = f"{where} has the state {state}, but the states of `{played.spec}` are 0 to {count - 1}"
            raise _REFUSALS.broken_error(str(suite.baseline), why)


def default_output(suite: Path) -> Path:
    """Return the path to which ``tltlc baseline`` writes the baseline of a suite by default.

    The file is beside the suite. For the suite that comes with the package, the file is in the
    working directory instead.
    """
    return Path("shipped.baseline.json") if suite == SHIPPED else baseline_path(suite)


def baseline_command(suite: Suite) -> str:
    """Return the shell command that records the baseline of a suite: ``tltlc baseline suite.toml``."""
    words = ["tltlc", "baseline", *([] if suite.path == SHIPPED else [path_text(suite.path)])]
    if suite.baseline != default_output(suite.path):
        words += ["--output", path_text(suite.baseline)]
    return join(words)


@record
class _StoredReference:
    """A :class:`Reference` in the form in which a baseline's file stores it.

    The episodes have the key ``accounts``. The texts of the level's files are missing: the baseline
    has one table with the texts of all references, because levels and variants share files.
    """

    played: Identity
    accounts: tuple[ExplainedEpisode, ...]
    sources: str = ""


@record
class _BaselineDocument:
    format: str
    version: int
    references: tuple[_StoredReference, ...]
    texts: Mapping[str, tuple[str, ...]] = EMPTY
    """The lines of each text, by the SHA-256 of the text."""


def _agree(first: Identity, second: Identity, names: tuple[str, ...]) -> bool:
    """Whether two identities have equal values in all fields called ``names``."""
    return all(getattr(first, name) == getattr(second, name) for name in names)
