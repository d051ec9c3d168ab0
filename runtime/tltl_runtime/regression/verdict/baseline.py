"""The baseline of a suite: what its policies did on the levels as designed, in a JSON file."""

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
    """What was played: policy, level, variant, spec and seed of the episodes.

    ``level`` and ``spec`` are names. ``level_hash`` is from
    :meth:`~tltl_runtime.game.game.Game.level_hash`, ``spec_hash`` from
    :func:`~tltl_runtime.policies.identity.spec_hash`. ``policy`` is the SHA-256 of the policy's
    file. ``files`` are the files that the level was loaded from, each with its SHA-256.
    ``versions`` are those of the software that played. ``place`` distinguishes levels of the same
    name, as in :class:`~tltl_runtime.regression.suite.suite.Case`.
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
    """The recorded episodes that cases are compared with.

    ``played`` identifies what was played. ``episodes`` are all of them, in order from episode 0.
    ``texts`` are pairs of the name of a level's file, as in ``played.files``, and its text.
    ``sources`` is the hash of the code that played, or empty if unknown.
    """

    played: Identity
    episodes: tuple[ExplainedEpisode, ...]
    texts: tuple[tuple[str, str], ...] = ()
    sources: str = ""


def write_baseline(path: Path, references: tuple[Reference, ...]) -> None:
    """Write the baseline of a suite. Raises TltlError, TLT0005, if the file cannot be written."""
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
    """Return the name and the text of each file in ``played.files`` whose text is known.

    ``texts`` has the known texts, by their SHA-256.
    """
    return tuple((name, texts[sha256]) for name, sha256 in played.files if sha256 in texts)


def _lines(sha256: str, lines: Sequence[str]) -> str:
    items = ",\n".join(map(_json, lines))
    return f'"{sha256}":[\n{items}]'


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def text_sha256(text: str) -> str:
    """Return the SHA-256, in hexadecimal, of a text in UTF-8, as ``Level.files`` has it for each file."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def _flaws(episode: ExplainedEpisode) -> Iterator[str]:
    """Yield a message for each impossible value in an episode of a baseline."""
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
    """Yield the states of the automaton that an episode mentions."""
    yield episode.summary.unmet
    yield from (arrival.state for arrival in episode.arrivals)
    yield from (state for *_, state, _ in episode.way)


def baseline_of(suite: Suite) -> tuple[Reference, ...]:
    """Read the baseline of a suite.

    Raises:
        TltlError: TLT0903, the suite has no baseline; the errors of :func:`read_baseline`.
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
    """Return the reference that has the level, variant, spec, policy and seed of ``identity``.

    The level may have been edited since: its hash is not compared.

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
    """Raise TltlError, TLT0902, if an episode of ``reference`` has a state that the automaton lacks."""
    count, played = len(fspa.states), reference.played
    for episode in reference.episodes:
        if (state := max(_states(episode))) >= count:
            where = f"episode {episode.summary.index} of `{played.level}:{played.variant}`"
            why = f"{where} has the state {state}, but the states of `{played.spec}` are 0 to {count - 1}"
            raise _REFUSALS.broken_error(str(suite.baseline), why)


def default_output(suite: Path) -> Path:
    """Return the path to which ``tltlc baseline`` writes the baseline of a suite by default.

    For the suite that comes with the package, the file is in the working directory, not in the
    package.
    """
    return Path("shipped.baseline.json") if suite == SHIPPED else baseline_path(suite)


def baseline_command(suite: Suite) -> str:
    """Return the shell command that records the baseline of a suite."""
    words = ["tltlc", "baseline", *([] if suite.path == SHIPPED else [path_text(suite.path)])]
    if suite.baseline != default_output(suite.path):
        words += ["--output", path_text(suite.baseline)]
    return join(words)


@record
class _StoredReference:
    """A reference as the file of a baseline stores it: without the texts of the level's files.

    The file stores all texts in one table, because levels and variants share files. It stores the
    episodes under the key ``accounts``.
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
    """Whether two identities agree in the fields called ``names``."""
    return all(getattr(first, name) == getattr(second, name) for name in names)
