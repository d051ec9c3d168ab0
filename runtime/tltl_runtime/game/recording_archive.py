"""The archives of recorded episodes: a text of JSON, the artefact of a spec, and arrays of numbers.

They are compressed NumPy archives. Reading one executes nothing and trusts nothing: sizes, types,
shapes and ranges are checked.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from functools import lru_cache
from io import BytesIO
from math import inf
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.numpy_archive import ArchiveError, read_array, read_members
from tltl_runtime.support.load_errors import LoadErrors
from tltlc.api import Diagnostic, Fspa, SourceFile, TltlError, compiler, fileio, record

Arrays = Mapping[str, NDArray[Any]]

MAX_BYTES: Final = fileio.limits.RECORDING.size
"""The greatest size of a file, and of all its arrays when they are unpacked: 256 MiB.

That is about half a million decisions of the stealth game.
"""

ERRORS: Final = LoadErrors("an", "episode", "TLT0820", "TLT0821", "TLT0822", again="record the episode again")

STEALTH_FORMAT: Final = "tltl-episode"
SCENE_FORMAT: Final = "tltl-scene-episode"
"""The formats of recordings. They tell to which game a recording belongs."""

_TAPES: Final = (".tape.jsonl", ".tape.jsonl.gz")
"""The endings of the names of tapes, which are other files than recordings."""

_TEXTS: Final = ("meta", "artefact")
"""The arrays that contain the bytes of a UTF-8 text."""


@record
class Array:
    """The format of an array in an episode's file.

    ``dtype`` is in NumPy's notation. ``shape`` contains numbers, and names of axes whose lengths depend
    on the episode: ``("n", "atoms")``. Values are from ``low`` to ``high``; with ``gaps``, they may also
    be not-a-number. ``doc`` says what they are.
    """

    name: str
    dtype: str
    shape: tuple[str | int, ...]
    unit: str
    doc: str
    low: float = -inf
    high: float = inf
    gaps: bool = False

    def actual_shape(self, sizes: Mapping[str, int]) -> tuple[int, ...]:
        """Return the shape, with the length from ``sizes`` in place of each axis's name."""
        return tuple(size if isinstance(size, int) else sizes[size] for size in self.shape)


def archive_bytes(meta: Any, fspa: Fspa, arrays: Arrays) -> bytes:
    """Return the bytes of an archive; equal arguments give equal bytes. ``meta`` is JSON data."""
    texts = {"meta": json.dumps(meta, ensure_ascii=False, allow_nan=False), "artefact": _artefact_text(fspa)}
    contents: dict[str, Any] = {name: np.frombuffer(text.encode(), dtype=np.uint8) for name, text in texts.items()}
    contents |= arrays
    archive = BytesIO()
    np.savez_compressed(archive, **contents)
    return archive.getvalue()


@fileio.resource_limits()
def format_of(path: Path) -> str | None:
    """Return the format of a recording; None if the file cannot be read or is no recording."""
    try:
        archive = RecordingArchive(fileio.read_bytes(path, str(path), MAX_BYTES), str(path), ())
        return archive.document()[0]
    except TltlError:
        return None


class RecordingArchive:
    """The archive with the bytes ``data``; messages call the file ``name``.

    ``arrays`` are the names of the arrays to read. The archive may lack some; others in it are ignored.

    Raises:
        TltlError: TLT0820, ``data`` is not a whole archive, is too large, or has no ``meta``.
    """

    def __init__(self, data: bytes, name: str, arrays: Iterable[str]) -> None:
        self._name = name
        if len(data) > MAX_BYTES:
            raise ERRORS.unreadable_error(name, f"it is larger than {MAX_BYTES >> 20} MiB")
        try:
            self._members = read_members(data, [*_TEXTS, *arrays], MAX_BYTES)
        except ArchiveError as error:
            if name.endswith(_TAPES):
                help_ = "`tltlc record LEVEL --tape FILE` plays a tape again and records the episode"
                raise TltlError([Diagnostic("TLT0820", f"`{name}` is a tape, not an episode", help=help_)]) from None
            raise ERRORS.unreadable_error(name, str(error)) from None
        if "meta" not in self._members:
            raise ERRORS.unreadable_error(name, "it is another kind of archive")

    def meta(self, format_: str, version: int) -> dict[str, Any]:
        """Return the JSON object ``meta``, which must have this format and version.

        Raises:
            TltlError: TLT0820, it has another ``format``; TLT0821, it has another ``version``; TLT0822,
                it is not JSON.
        """
        own, document = self.document()
        if own != format_:
            raise ERRORS.unreadable_error(self._name, "it is another kind of archive")
        ERRORS.check_version(self._name, document.get("version"), version)
        return document

    def document(self) -> tuple[str, dict[str, Any]]:
        """Return the format of the recording, and the JSON object ``meta``, of any version.

        Raises:
            TltlError: TLT0820, it is no recording; TLT0822, ``meta`` is not JSON.
        """
        try:
            document = fileio.parse_json(self._text("meta"), fileio.limits.RECORDED_TEXTS["meta"])
        except (ValueError, RecursionError):
            raise ERRORS.broken_error(self._name, "`meta` is not JSON") from None
        format_ = document.get("format") if isinstance(document, dict) else None
        if format_ not in (STEALTH_FORMAT, SCENE_FORMAT):
            raise ERRORS.unreadable_error(self._name, "it is another kind of archive")
        return format_, document

    def automaton(self) -> Fspa:
        """Return the automaton; raises TltlError, TLT0822 or TLT0601 to TLT0604, if it is invalid."""
        text = self._text("artefact")
        try:
            return _automaton(text)
        except TltlError:
            # Read it again under the name of the file, so that the error contains this name.
            return compiler.read_artefact(SourceFile(f"{self._name}/artefact", text))

    def array(self, name: str) -> NDArray[Any]:
        """Return an array of any type and shape; raises TltlError, TLT0822, if there is none."""
        if name not in self._members:
            raise ERRORS.broken_error(self._name, f"the array `{name}` is missing")
        try:
            return read_array(self._members[name])
        except ArchiveError as error:
            raise ERRORS.broken_error(self._name, f"the array `{name}`: {error}") from None

    def row_count(self, name: str) -> int:
        """Return the length of the first axis of an array; 0 if it has no axes."""
        array = self.array(name)
        return array.shape[0] if array.ndim else 0

    def arrays(self, arrays: Iterable[Array], sizes: Mapping[str, int]) -> dict[str, NDArray[Any]]:
        """Return arrays by name, after checking them; ``sizes`` has the lengths of the named axes.

        Raises:
            TltlError: TLT0822, an array is missing, or its type, its shape or one of its values is wrong.
        """
        return {array.name: self._checked(array, array.actual_shape(sizes)) for array in arrays}

    def _checked(self, array: Array, shape: tuple[int, ...]) -> NDArray[Any]:
        values = self.array(array.name)
        if values.dtype != np.dtype(array.dtype) or values.shape != shape:
            problem = f"the array `{array.name}` is {values.dtype.str} of shape {values.shape}"
            raise ERRORS.broken_error(self._name, f"{problem}, not {array.dtype} of shape {shape}")
        if values.dtype == np.bool_:
            valid = bool((values.view(np.uint8) <= 1).all())
        else:
            # The comparisons reject not-a-number; isfinite also rejects infinities.
            fit = (values >= array.low) & (values <= array.high) & np.isfinite(values)
            valid = bool((fit | np.isnan(values) if array.gaps else fit).all())
        if not valid:
            raise ERRORS.broken_error(self._name, f"the array `{array.name}` has invalid values")
        return values

    def _text(self, name: str) -> str:
        data = self.array(name)
        if data.dtype != np.uint8 or data.ndim != 1:
            raise ERRORS.broken_error(self._name, f"the array `{name}` does not contain bytes")
        limit = fileio.limits.RECORDED_TEXTS[name]
        if data.size > limit.size or np.count_nonzero(data == ord(",")) >= (limit.values or 0):
            most = f"{limit.size >> 20} MiB or {limit.values:,} values"
            raise ERRORS.broken_error(self._name, f"the array `{name}` contains more than {most}")
        try:
            return data.tobytes().decode()
        except UnicodeDecodeError:
            raise ERRORS.broken_error(self._name, f"the array `{name}` is not UTF-8 text") from None


@lru_cache(maxsize=8)
def _artefact_text(fspa: Fspa) -> str:
    """Return an automaton's artefact as text, cached because the episodes of a spec share it."""
    (artefact,) = compiler.emit("json", fspa).values()
    return str(artefact)


@lru_cache(maxsize=8)
def _automaton(artefact: str) -> Fspa:
    """Return the automaton in an artefact, cached because the episodes of a spec share it."""
    return compiler.read_artefact(SourceFile("artefact", artefact))
