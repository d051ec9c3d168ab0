"""Split the bytes from an editor into messages: headers, an empty line, and a body.

Some editors announce wrong lengths. So a body, which is JSON, ends at the bracket that closes its
first bracket, even if the header announces more bytes: an editor that waits for an answer sends
nothing more. A body also ends at the next header. A JSON string contains no raw line break, so a
line ``Content-Length: N`` cannot be part of a JSON text and always starts a message.
"""

from __future__ import annotations

import re
from typing import Final, Union

from tltlc.core.record import record
from tltlc.interfaces.lsp.json_end import JsonEnd
from tltlc.io.limits import MESSAGE, MESSAGE_HEAD

_TYPE: Final = rb"Content-Type:[^\r\n]{0,200}"
_WHITE: Final = b" \t\r\n"
"""JSON white space."""
_SPACE: Final = rb"[ \t]{0,16}"
_HEADER: Final = re.compile(
    rb"(?:%s\r?\n)?Content-Length:%s([0-9]{1,64})%s\r?\n" % (_TYPE, _SPACE, _SPACE), re.IGNORECASE
)
_OTHER_HEADER: Final = re.compile(rb"Content-Type:", re.IGNORECASE)
_OVERLAP: Final = 512
"""How many bytes at the end of the buffer are searched again when more arrive.

They may contain the start of a header. Both header lines together are shorter than this.
"""
_MOST_DIGITS: Final = 9


@record
class Body:
    """The body of a message, not yet checked."""

    data: bytes


@record
class Fault:
    """A problem with the headers of a message, described in ``text``.

    If ``is_answered``, the editor gets an error response; otherwise the fault is only logged.
    """

    text: str
    is_answered: bool = False


MessageFrame = Union[Body, Fault]
"""What is found in the bytes: the body of a message, or a fault of its headers."""


class Frames:
    """Splits a stream of bytes into frames: the bodies of messages, and faults of their headers."""

    def __init__(self) -> None:
        self._buffer = bytearray()
        self._searched = 0
        """Length of the start of the buffer that contains no header."""
        self._length: int | None = None
        """Length of the next body in bytes, from its header; None before the header."""
        self._in_body = False
        self._json_end = JsonEnd()
        self._padding = 0
        """How many more bytes the header announced after the last bracket of the last body."""
        self._padding_fault: Fault | None = None
        """The fault to report if the bytes that ``_padding`` counts are not all white space."""
        self._is_skipping = False
        """Whether bytes are being skipped up to the next header. This is reported only once."""
        self._frames: list[MessageFrame] = []

    def feed(self, data: bytes) -> list[MessageFrame]:
        """Take the next bytes of the stream, and return the frames that are now complete."""
        self._buffer += data
        while self._read_part():
            pass
        return self._take_frames()

    def end(self) -> list[MessageFrame]:
        """Return the remaining frames at the end of the stream; an incomplete body becomes a frame."""
        if self._in_body and self._buffer:
            self._add_body(len(self._buffer))
        return self._take_frames()

    def _read_part(self) -> bool:
        """Read the next header line, body or padding; return False if its bytes have not all arrived."""
        if self._in_body:
            return self._read_body()
        return self._read_padding() if self._padding else self._read_line()

    def _take_frames(self) -> list[MessageFrame]:
        frames, self._frames = self._frames, []
        return frames

    # --- headers ------------------------------------------------------------------------------

    def _read_line(self) -> bool:
        """Read a line of the headers; return False if its bytes have not all arrived."""
        if self._length is not None and self._buffer.startswith((b"{", b"[")):
            self._frames.append(Fault("a message has no empty line before it, but it is read as if it had one"))
            self._begin_body()
            return True
        end = self._buffer.find(b"\n", self._searched)
        if end < 0:
            self._drop_long_line()
            return False
        line = bytes(self._buffer[: end + 1])
        self._drop(end + 1)
        header = _HEADER.search(line)
        self._pass_over(line[: header.start()] if header else line, is_long=len(line) > MESSAGE_HEAD.size)
        if header:
            self._take_length(header[1])
        elif not line.strip() and self._length is not None:
            self._begin_body()
        return True

    def _take_length(self, digits: bytes) -> None:
        number = digits.lstrip(b"0")
        length = int(number or b"0") if len(number) <= _MOST_DIGITS else MESSAGE.size + 1
        if self._length not in (None, length):
            self._frames.append(Fault("a message has two lengths; the last one is used"))
        self._length = length
        self._is_skipping = False

    def _begin_body(self) -> None:
        if (self._length or 0) > MESSAGE.size:
            self._frames.append(Fault(f"a message is larger than {MESSAGE.size >> 20} MiB and is skipped", True))
            # The bytes of the body may never come, so search for the next header at once.
            self._length, self._is_skipping = None, True
        else:
            self._in_body = True
            self._json_end = JsonEnd()

    def _pass_over(self, skipped: bytes, *, is_long: bool) -> None:
        """Record a fault for skipped bytes; adjacent skipped bytes get only one fault.

        White space gets no fault, and neither does a header ``Content-Type``, unless its line is too
        long (``is_long``).
        """
        if skipped.strip() and not self._is_skipping and (is_long or not _OTHER_HEADER.match(skipped)):
            self._is_skipping = True
            self._frames.append(Fault(f"a message without a header `Content-Length` is skipped: {skipped[:60]!r}"))

    def _drop_long_line(self) -> None:
        """If the unfinished line in the buffer is too long, drop its start and record a fault.

        The last ``_OVERLAP`` bytes remain, because the next header may start there.
        """
        self._searched = len(self._buffer)
        if len(self._buffer) > MESSAGE_HEAD.size:
            self._pass_over(bytes(self._buffer[:-_OVERLAP]), is_long=True)
            self._drop(len(self._buffer) - _OVERLAP)
            self._searched = len(self._buffer)

    # --- bodies -------------------------------------------------------------------------------

    def _read_body(self) -> bool:
        """Read a body up to its last bracket, its announced length or the next header, whichever comes first.

        Return False if the end of the body has not arrived.
        """
        length = self._length or 0
        json_end = self._json_end.find(self._buffer, length)
        limit = length if json_end is None else json_end
        start = max(0, self._searched - _OVERLAP)
        # A header contains a line break, but most bodies do not. This is quick to check.
        has_lines = self._buffer.find(b"\n", start, limit) >= 0
        header = _HEADER.search(self._buffer, start, limit) if has_lines else None
        if header:
            self._frames.append(_short_body(header.start(), length))
            self._add_body(header.start())
        elif json_end is not None:
            self._padding, self._padding_fault = length - json_end, _short_body(json_end, length)
            self._add_body(json_end)
        elif len(self._buffer) >= length:
            partial = _partial_header_size(bytes(self._buffer[max(0, length - _OVERLAP) : length]))
            if partial:
                self._frames.append(_short_body(length - partial, length))
            self._add_body(length - partial)
        else:
            self._searched = len(self._buffer)
            return False
        return True

    def _read_padding(self) -> bool:
        """Skip white space after the last bracket of a body, up to the length that its header announced.

        Return True once all these bytes are skipped, and False if some have not arrived. If one of
        them is not white space, the header was wrong: record a fault, and search for the next
        header.
        """
        padding = self._buffer[: self._padding]
        blank = len(padding) - len(padding.lstrip(_WHITE))
        self._drop(blank)
        self._padding -= blank
        if blank < len(padding) and self._padding_fault:
            self._frames.append(self._padding_fault)
            # Report no other fault for the bytes that are skipped up to the next header.
            self._padding, self._is_skipping = 0, True
        return self._padding == 0

    def _add_body(self, size: int) -> None:
        self._frames.append(Body(bytes(self._buffer[:size])))
        self._drop(size)
        self._length, self._in_body, self._is_skipping = None, False, False

    def _drop(self, size: int) -> None:
        del self._buffer[:size]
        self._searched = 0


def _short_body(size: int, length: int) -> Fault:
    return Fault(f"a message is shorter than its header says: {size} bytes, not {length}")


def _prefix_pattern(word: bytes, ending: bytes) -> bytes:
    """Return a pattern that matches each shorter prefix of a word, and the word followed by ``ending``.

    For ``b"ab"``, the pattern is ``(?:a(?:bENDING)?)?``.
    """
    pattern = ending
    for letter in reversed(word):
        pattern = b"(?:%c%s)?" % (letter, pattern)
    return pattern


_PARTIAL_HEADER: Final = re.compile(
    rb"(?:%s\r?\n)?(?:%s|%s)\Z"
    % (
        _TYPE,
        _prefix_pattern(b"Content-Type:", rb"[^\r\n]{0,200}\r?"),
        _prefix_pattern(b"Content-Length:", rb"%s[0-9]{0,64}%s\r?" % (_SPACE, _SPACE)),
    ),
    re.IGNORECASE,
)


def _partial_header_size(tail: bytes) -> int:
    """Return how many bytes at the end of a body may be the start of the next header.

    No JSON message ends with such bytes.
    """
    match = _PARTIAL_HEADER.search(tail)
    return len(match[0]) if match else 0
