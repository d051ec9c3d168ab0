"""Cut what an editor sends into messages: headers, an empty line, and a body of as many bytes as a header says.

Editors have faults, so lengths can be wrong. A body ends at the bracket that closes its first one, even if its header
says that more bytes come: an editor that waits for an answer sends no more. A body also ends at the next header. A raw
line ``Content-Length: N`` can be no part of a JSON text, since JSON has no line breaks inside strings; so wherever one
stands, a message begins there.
"""

from __future__ import annotations

import re
from typing import Final, Union

from tltlc.core.record import record
from tltlc.interfaces.lsp.json_end import JsonEnd
from tltlc.io.limits import MESSAGE, MESSAGE_HEAD

_TYPE: Final = rb"Content-Type:[^\r\n]{0,200}"
_WHITE: Final = b" \t\r\n"
"""White space in JSON."""
_SPACE: Final = rb"[ \t]{0,16}"
_HEADER: Final = re.compile(
    rb"(?:%s\r?\n)?Content-Length:%s([0-9]{1,64})%s\r?\n" % (_TYPE, _SPACE, _SPACE), re.IGNORECASE
)
_OTHER_HEADER: Final = re.compile(rb"Content-Type:", re.IGNORECASE)
_OVERLAP: Final = 512
"""More bytes than the two headers together have; what is searched again when more has come."""
_MOST_DIGITS: Final = 9


@record
class Body:
    """A message, which may still be anything."""

    data: bytes


@record
class Fault:
    """Something that is wrong with the headers, in words; ``is_answered`` is whether the editor is told."""

    text: str
    is_answered: bool = False


Frame = Union[Body, Fault]


class Frames:
    """What has come of messages that are not complete."""

    def __init__(self) -> None:
        self._buffer = bytearray()
        self._searched = 0
        """How much of the buffer holds no header."""
        self._length: int | None = None
        """What a header of the next message says."""
        self._in_body = False
        self._json_end = JsonEnd()
        self._left = 0
        """How many bytes come behind the last bracket of the last body, as its header says."""
        self._doubt: Fault | None = None
        """What is wrong if they are more than white space."""
        self._is_lost = False
        """Whether it was said already that something is passed over."""
        self._found: list[Frame] = []

    def feed(self, data: bytes) -> list[Frame]:
        """What is complete with these bytes; it is the same in whichever pieces they come."""
        self._buffer += data
        while self._read_part():
            pass
        return self._taken()

    def end(self) -> list[Frame]:
        """What there is of the last message, when nothing more comes."""
        if self._in_body and self._buffer:
            self._give(len(self._buffer))
        return self._taken()

    def _read_part(self) -> bool:
        """Read the next part of a message; False where it is not complete."""
        if self._in_body:
            return self._read_body()
        return self._read_padding() if self._left else self._read_line()

    def _taken(self) -> list[Frame]:
        found, self._found = self._found, []
        return found

    # --- headers ------------------------------------------------------------------------------

    def _read_line(self) -> bool:
        """Read a line of the headers; False where it is not complete."""
        if self._length is not None and self._buffer.startswith((b"{", b"[")):
            self._found.append(Fault("a message without an empty line before it is read as if it had one"))
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
            self._found.append(Fault("a message has two lengths, of which the last one counts"))
        self._length = length
        self._is_lost = False

    def _begin_body(self) -> None:
        if (self._length or 0) > MESSAGE.size:
            self._found.append(Fault(f"a message is larger than {MESSAGE.size >> 20} MiB, and is passed over", True))
            # Its bytes may never come, so the next header is looked for at once.
            self._length, self._is_lost = None, True
        else:
            self._in_body = True
            self._json_end = JsonEnd()

    def _pass_over(self, lost: bytes, *, is_long: bool) -> None:
        """Say once that something stands where a header should."""
        if lost.strip() and not self._is_lost and (is_long or not _OTHER_HEADER.match(lost)):
            self._is_lost = True
            self._found.append(Fault(f"a message without a header `Content-Length` is passed over: {lost[:60]!r}"))

    def _drop_long_line(self) -> None:
        """Keep only the end of a line that is too long for a header: the next header may begin there."""
        self._searched = len(self._buffer)
        if len(self._buffer) > MESSAGE_HEAD.size:
            self._pass_over(bytes(self._buffer[:-_OVERLAP]), is_long=True)
            self._drop(len(self._buffer) - _OVERLAP)
            self._searched = len(self._buffer)

    # --- bodies -------------------------------------------------------------------------------

    def _read_body(self) -> bool:
        """Read a body, up to its last bracket, its length or the next header; False where none of them has come."""
        length = self._length or 0
        json_end = self._json_end.find(self._buffer, length)
        limit = length if json_end is None else json_end
        start = max(0, self._searched - _OVERLAP)
        # Most bodies have no line breaks, which is soon known.
        has_lines = self._buffer.find(b"\n", start, limit) >= 0
        header = _HEADER.search(self._buffer, start, limit) if has_lines else None
        if header:
            self._found.append(_short(header.start(), length))
            self._give(header.start())
        elif json_end is not None:
            self._left, self._doubt = length - json_end, _short(json_end, length)
            self._give(json_end)
        elif len(self._buffer) >= length:
            begun = _begun_header(bytes(self._buffer[max(0, length - _OVERLAP) : length]))
            if begun:
                self._found.append(_short(length - begun, length))
            self._give(length - begun)
        else:
            self._searched = len(self._buffer)
            return False
        return True

    def _read_padding(self) -> bool:
        """Pass over white space behind the last bracket of a body; if anything else is there, its header was wrong."""
        padding = self._buffer[: self._left]
        blank = len(padding) - len(padding.lstrip(_WHITE))
        self._drop(blank)
        self._left -= blank
        if blank < len(padding) and self._doubt:
            self._found.append(self._doubt)
            # What is passed over up to the next header is part of the same fault.
            self._left, self._is_lost = 0, True
        return self._left == 0

    def _give(self, size: int) -> None:
        self._found.append(Body(bytes(self._buffer[:size])))
        self._drop(size)
        self._length, self._in_body, self._is_lost = None, False, False

    def _drop(self, size: int) -> None:
        del self._buffer[:size]
        self._searched = 0


def _short(size: int, length: int) -> Fault:
    return Fault(f"a message is shorter than its header says: {size} bytes, not {length}")


def _beginnings(word: bytes, behind: bytes) -> bytes:
    """A pattern for every beginning of a word, and for the whole word with the beginnings of what is behind it."""
    pattern = behind
    for letter in reversed(word):
        pattern = b"(?:%c%s)?" % (letter, pattern)
    return pattern


_BEGUN_HEADER: Final = re.compile(
    rb"(?:%s\r?\n)?(?:%s|%s)\Z"
    % (
        _TYPE,
        _beginnings(b"Content-Type:", rb"[^\r\n]{0,200}\r?"),
        _beginnings(b"Content-Length:", rb"%s[0-9]{0,64}%s\r?" % (_SPACE, _SPACE)),
    ),
    re.IGNORECASE,
)


def _begun_header(tail: bytes) -> int:
    """How many bytes at the end of a body begin the next header; no JSON text of a message ends with such bytes."""
    found = _BEGUN_HEADER.search(tail)
    return len(found[0]) if found else 0
