"""Parse the head of an HTTP/1.1 request (RFC 9112) without any input or output.

The parser accepts less than the standard allows: no transfer codings, no continued header lines,
no second ``Host``. It refuses everything ambiguous.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from http import HTTPStatus
from typing import Final
from urllib.parse import unquote_to_bytes

from tltlc.core.record import record
from tltlc.io.limits import REQUEST_HEAD, REQUEST_LINE

_TOKEN: Final = rb"[!#$%&'*+.^_`|~0-9A-Za-z-]+"
# In these patterns, two adjacent parts never match the same character. So matching takes linear time.
_LINE: Final = re.compile(rb"(%s) ([!-~]+) HTTP/([0-9])\.([0-9])" % _TOKEN)
_NAME: Final = re.compile(_TOKEN)
_VALUE: Final = re.compile(rb"[\t -~\x80-\xff]*")
_END: Final = re.compile(rb"\n\r?\n")
_BAD_ESCAPE: Final = re.compile(r"%(?![0-9A-Fa-f]{2})")
_MOST_DIGITS: Final = 18
_REPEATED: Final = {"accept", "accept-encoding", "accept-language", "cache-control", "connection", "via"}
"""Headers that may be repeated, because their values are lists; only ``connection`` is used."""


class RefusedError(Exception):
    """Raised for a request that is refused with an error status; then the connection is closed."""

    def __init__(self, status: HTTPStatus) -> None:
        self.status = status
        super().__init__(status.phrase)


@record
class Head:
    """An HTTP request without its body.

    ``path`` is the path of the target, unescaped and without query. The names in ``headers`` are in
    lower case. ``length`` is the length of the body in bytes; None if the request does not give it.
    ``keeps_alive`` says whether another request may follow on the connection, and ``is_http_1_0``
    whether the client speaks HTTP/1.0, which has no interim answers.
    """

    method: str
    path: str
    headers: Mapping[str, str]
    length: int | None
    keeps_alive: bool
    is_http_1_0: bool

    @property
    def expects_continue(self) -> bool:
        """Whether the client sends the body only after an answer ``100 Continue``."""
        return "expect" in self.headers


def read_head(data: bytes) -> tuple[Head, int] | None:
    """Parse the head of the request at the start of ``data``.

    Return the head and the offset after it, or None if the head is incomplete. Raises RefusedError
    as early as possible, with the status:

    - 400 if the bytes are not HTTP, or are ambiguous;
    - 413 if the length of the body has too many digits;
    - 414 if the first line is too long, 431 if the headers are;
    - 417 for an unknown expectation;
    - 501 for transfer codings;
    - 505 for another major version than 1.
    """
    # Empty lines before a request are allowed (RFC 9112, 2.2).
    start = len(data) - len(data.lstrip(b"\r\n"))
    if start > REQUEST_HEAD.size:
        raise RefusedError(HTTPStatus.BAD_REQUEST)
    line_end = data.find(b"\n", start)
    if (line_end if line_end >= 0 else len(data)) - start >= REQUEST_LINE.size:
        raise RefusedError(HTTPStatus.REQUEST_URI_TOO_LONG)
    if line_end < 0:
        return None
    method, path, is_http_1_0 = _first_line(data[start:line_end].removesuffix(b"\r"))
    end = _END.search(data, line_end)
    text = data[line_end + 1 : end.start() if end else len(data)]
    if len(text) > REQUEST_HEAD.size or text.count(b"\n") >= (REQUEST_HEAD.values or 0):
        raise RefusedError(HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE)
    if end is None:
        return None
    headers = _headers(text)
    return _head(method, path, headers, is_http_1_0), end.end()


def _first_line(line: bytes) -> tuple[str, str, bool]:
    """Parse the first line of a request: return the method, the path, and whether this is HTTP/1.0."""
    match = _LINE.fullmatch(line)
    if match is None:
        raise RefusedError(HTTPStatus.BAD_REQUEST)
    if match[3] != b"1":
        raise RefusedError(HTTPStatus.HTTP_VERSION_NOT_SUPPORTED)
    target = match[2].decode("ascii").partition("?")[0]
    # A target that is neither a path nor `*` is for a proxy.
    if not target.startswith("/") and target != "*":
        raise RefusedError(HTTPStatus.BAD_REQUEST)
    return match[1].decode("ascii"), _unescape(target), match[4] == b"0"


def _unescape(path: str) -> str:
    if _BAD_ESCAPE.search(path):
        raise RefusedError(HTTPStatus.BAD_REQUEST)
    try:
        text = unquote_to_bytes(path).decode("utf-8")
    except UnicodeDecodeError:
        raise RefusedError(HTTPStatus.BAD_REQUEST) from None
    if any(ord(character) < ord(" ") or character == "\x7f" for character in text):
        raise RefusedError(HTTPStatus.BAD_REQUEST)
    return text


def _headers(text: bytes) -> dict[str, str]:
    headers: dict[str, str] = {}
    for line in text.split(b"\n") if text.strip(b"\r\n") else ():
        name, value = _header(line.removesuffix(b"\r"))
        if name in headers and name not in _REPEATED:
            raise RefusedError(HTTPStatus.BAD_REQUEST)
        headers[name] = f"{headers[name]}, {value}" if name in headers else value
    return headers


def _header(line: bytes) -> tuple[str, str]:
    """Parse a header line: return the name in lower case, and the value without surrounding blanks."""
    name, colon, value = line.partition(b":")
    if not (colon and _NAME.fullmatch(name) and _VALUE.fullmatch(value)):
        raise RefusedError(HTTPStatus.BAD_REQUEST)
    return name.decode("ascii").lower(), value.strip(b" \t").decode("latin-1")


def _head(method: str, path: str, headers: Mapping[str, str], is_http_1_0: bool) -> Head:
    if not is_http_1_0 and "host" not in headers:
        raise RefusedError(HTTPStatus.BAD_REQUEST)
    if "transfer-encoding" in headers:
        has_length = "content-length" in headers
        raise RefusedError(HTTPStatus.BAD_REQUEST if has_length else HTTPStatus.NOT_IMPLEMENTED)
    if headers.get("expect", "100-continue").lower() != "100-continue":
        raise RefusedError(HTTPStatus.EXPECTATION_FAILED)
    closes = "close" in (word.strip() for word in headers.get("connection", "").lower().split(","))
    length = _length(headers.get("content-length"))
    return Head(method, path, headers, length, keeps_alive=not (is_http_1_0 or closes), is_http_1_0=is_http_1_0)


def _length(text: str | None) -> int | None:
    if text is None:
        return None
    if not (text.isascii() and text.isdecimal()):
        raise RefusedError(HTTPStatus.BAD_REQUEST)
    digits = text.lstrip("0")
    if len(digits) > _MOST_DIGITS:
        raise RefusedError(HTTPStatus.REQUEST_ENTITY_TOO_LARGE)
    return int(digits or "0")
