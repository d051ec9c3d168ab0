"""The page on this machine: the files of the page, and answers to what it asks."""

from __future__ import annotations

import mimetypes
import os
import select
import socket
import sys
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, Final
from urllib.parse import urlsplit

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.files import reason
from tltlc.playground.children import LIMIT_S, AbandonedError, Children
from tltlc.playground.site import page_files

HOST: Final = "127.0.0.1"
MOST_BYTES: Final = 4 << 20
"""Of a request: a text as large as a source file may be, written as JSON, and a trace."""

_NAMES: Final = {HOST, "localhost"}
"""Under other names a page of somebody else could ask, by an address that leads here."""

_POLICY: Final = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:"
_HEADERS: Final = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": f"{_POLICY}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}


class Server(ThreadingHTTPServer):
    """Serves the page at :data:`HOST`, and at no other address; port 0 is any that is free.

    Raises TltlError, TLT0776, where the port cannot be had.
    """

    daemon_threads = True
    # A port is free again as soon as its server has ended.  (On Windows it is so anyway, and this would share it with
    # a server that is still there.)
    allow_reuse_address = os.name != "nt"

    def __init__(self, port: int, limit_s: float = LIMIT_S) -> None:
        self.files = page_files()
        try:
            super().__init__((HOST, port), Handler)
        except OSError as error:
            title = f"cannot serve at {HOST}:{port}: {reason(error)}"
            way_out = "give another port, or 0 for any: `--port 0`"
            raise TltlError([Diagnostic("TLT0776", title, help=way_out)]) from None
        self.children = Children(limit_s)

    @property
    def address(self) -> str:
        """Where the page is."""
        return f"http://{HOST}:{self.server_address[1]}/"

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing where the page has gone, as it does when a text has changed before its answer came."""
        if not isinstance(sys.exc_info()[1], (ConnectionError, TimeoutError)):
            super().handle_error(request, client_address)

    def server_close(self) -> None:
        """Free the port, and end what waits."""
        super().server_close()
        if hasattr(self, "children"):
            self.children.close()


class Handler(BaseHTTPRequestHandler):
    """``GET`` of the page's files and ``POST api``."""

    server: Server
    protocol_version = "HTTP/1.1"
    server_version, sys_version = "tltlc", ""
    timeout = 60

    def do_GET(self) -> None:
        """A file of the page."""
        path = urlsplit(self.path).path
        name = "index.html" if path == "/" else path.removeprefix("/")
        if not self._is_for_us():
            self._refuse(HTTPStatus.FORBIDDEN)
        elif name not in self.server.files:
            self._refuse(HTTPStatus.NOT_FOUND)
        else:
            kind = "text/javascript" if name.endswith(".js") else mimetypes.guess_type(name)[0] or "text/plain"
            self._send(HTTPStatus.OK, self.server.files[name], f"{kind}; charset=utf-8")

    def do_POST(self) -> None:
        """The answer to a request of the page, which says that it is JSON: pages of others would have to ask first."""
        length = self.headers.get("Content-Length", "")
        if not self._is_for_us():
            self._refuse(HTTPStatus.FORBIDDEN)
        elif self.path != "/api":
            self._refuse(HTTPStatus.NOT_FOUND)
        elif self.headers.get_content_type() != "application/json":
            self._refuse(HTTPStatus.UNSUPPORTED_MEDIA_TYPE)
        elif not (length.isascii() and length.isdigit()):
            self._refuse(HTTPStatus.LENGTH_REQUIRED)
        elif int(length) > MOST_BYTES:
            self._refuse(HTTPStatus.REQUEST_ENTITY_TOO_LARGE)
        else:
            self._answer(self.rfile.read(int(length)))

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002
        """Nothing: only commands print."""

    def _answer(self, request: bytes) -> None:
        try:
            answered = self.server.children.answer(request, self._has_gone)
        except AbandonedError:
            self.close_connection = True
            return
        if answered is None:
            self._refuse(HTTPStatus.BAD_REQUEST)
        else:
            self._send(HTTPStatus.OK, answered.encode(), "application/json; charset=utf-8")

    def _has_gone(self) -> bool:
        """Whether who asked has hung up, as a page does that has a newer text to ask about."""
        ready, _, _ = select.select([self.connection], [], [], 0)
        return bool(ready) and not self.connection.recv(1, socket.MSG_PEEK)

    def _is_for_us(self) -> bool:
        name, _, port = self.headers.get("Host", "").partition(":")
        return name.lower() in _NAMES and (port.isdecimal() or not port)

    def _refuse(self, status: HTTPStatus) -> None:
        # What was not read would be taken for the next request.
        self.close_connection = True
        self._send(status, f"{status.phrase}\n".encode(), "text/plain; charset=utf-8")

    def _send(self, status: HTTPStatus, body: bytes, kind: str) -> None:
        self.send_response(status)
        for name, value in _HEADERS.items():
            self.send_header(name, value)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(body)
