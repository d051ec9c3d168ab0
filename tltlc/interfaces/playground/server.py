"""Serve the playground on this machine: the files of the web page, and the answers to its requests."""

from __future__ import annotations

import asyncio
import mimetypes
import os
import secrets
import signal
import socket
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from http import HTTPStatus
from threading import Event, Thread, current_thread, main_thread
from types import TracebackType
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.playground.children import LIMIT_S, MOST_AT_ONCE, AbandonedError, Children
from tltlc.interfaces.playground.connections import Connection, OpenConnections, Response, report_failure
from tltlc.interfaces.playground.request_head import Head, RefusedError
from tltlc.interfaces.playground.site import page_files
from tltlc.io.files import reason
from tltlc.io.limits import MESSAGE, PLAYGROUND, Connections

HOST: Final = "127.0.0.1"
TOKEN_HEADER: Final = "Tltlc-Token"

_NAMES: Final = {HOST, "localhost"}
"""The host names that requests may use.

All other host names are refused, because another page could use a domain name of its own that
resolves to this address.
"""

_API: Final = "/api"
_METHODS: Final = {"GET", "HEAD", "POST"}
_KNOWN_METHODS: Final = _METHODS | {"OPTIONS", "PUT", "DELETE", "PATCH", "TRACE", "CONNECT"}
_AGAIN_S: Final = 1.0
"""Seconds after which the server accepts connections again, if it lacked file descriptors for them."""

_OTHER_DESCRIPTORS: Final = 16 + 6 * MOST_AT_ONCE
"""The most file descriptors that the process itself and the pipes to its children need."""

_POLICY: Final = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:"
_HEADERS: Final = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": f"{_POLICY}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "Cross-Origin-Resource-Policy": "same-origin",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}


class PageHandler:
    """Answers requests ``GET`` for the files of the page, and requests ``POST`` to ``/api`` about a spec text.

    The header ``Tltlc-Token`` of a ``POST`` must be ``token``, a secret that only the page knows.
    """

    def __init__(self, children: Children, token: str) -> None:
        self.files = page_files()
        self._children = children
        self._token = token.encode()
        # A connection blocks its thread while it waits for a child, and there may be more connections than
        # children. So there is a thread for every connection.
        self._threads = ThreadPoolExecutor(PLAYGROUND.most)

    def check(self, head: Head) -> None:
        """Raise RefusedError if a request is not from the page, is not valid, or asks for something unknown."""
        if not _is_from_page(head):
            raise RefusedError(HTTPStatus.FORBIDDEN)
        if head.method not in _KNOWN_METHODS:
            raise RefusedError(HTTPStatus.NOT_IMPLEMENTED)
        if head.path == _API:
            self._check_question(head)
            return
        if _file_name(head.path) not in self.files:
            raise RefusedError(HTTPStatus.NOT_FOUND)
        if head.method not in ("GET", "HEAD"):
            raise RefusedError(HTTPStatus.METHOD_NOT_ALLOWED)
        if head.length:
            raise RefusedError(HTTPStatus.BAD_REQUEST)

    async def answer(self, head: Head, body: bytes, hung_up: Event) -> Response | None:
        """Return a file of the page, or the compiler's answer to a request of the page.

        Return None if the client no longer waits. Raises RefusedError if the body is not a valid
        request, or if no process can be started to answer it.
        """
        if head.path != _API:
            name = _file_name(head.path)
            kind = "text/javascript" if name.endswith(".js") else mimetypes.guess_type(name)[0] or "text/plain"
            return _response(HTTPStatus.OK, self.files[name], kind)
        loop = asyncio.get_running_loop()
        try:
            text = await loop.run_in_executor(self._threads, self._children.answer, body, hung_up.is_set)
        except AbandonedError:
            return None
        except OSError:
            # The system has no room for another process.
            raise RefusedError(HTTPStatus.SERVICE_UNAVAILABLE) from None
        if text is None:
            raise RefusedError(HTTPStatus.BAD_REQUEST)
        return _response(HTTPStatus.OK, text.encode(), "application/json")

    def error_response(self, status: HTTPStatus) -> Response:
        """Return the response for a refused request, with this status."""
        allowed = {"Allow": "GET, HEAD, POST"} if status is HTTPStatus.METHOD_NOT_ALLOWED else {}
        return _response(status, f"{status.phrase}\n".encode(), "text/plain", allowed)

    def close(self) -> None:
        """Take no more requests, and cancel those that no thread has begun to answer."""
        self._threads.shutdown(wait=False, cancel_futures=True)

    def _check_question(self, head: Head) -> None:
        # A client without the token learns nothing else.
        if not secrets.compare_digest(head.headers.get(TOKEN_HEADER.lower(), "").encode("latin-1"), self._token):
            raise RefusedError(HTTPStatus.FORBIDDEN)
        if head.method != "POST":
            raise RefusedError(HTTPStatus.METHOD_NOT_ALLOWED)
        # For this content type, other pages need a CORS preflight, which this server refuses.
        if head.headers.get("content-type", "").partition(";")[0].strip().lower() != "application/json":
            raise RefusedError(HTTPStatus.UNSUPPORTED_MEDIA_TYPE)
        if head.length is None:
            raise RefusedError(HTTPStatus.LENGTH_REQUIRED)
        if head.length > MESSAGE.size:
            raise RefusedError(HTTPStatus.REQUEST_ENTITY_TOO_LARGE)


def _response(status: HTTPStatus, body: bytes, kind: str, headers: dict[str, str] | None = None) -> Response:
    return Response(status, {**_HEADERS, "Content-Type": f"{kind}; charset=utf-8", **(headers or {})}, body)


def _file_name(path: str) -> str:
    return "index.html" if path == "/" else path.removeprefix("/")


def _is_from_page(head: Head) -> bool:
    """Whether the headers show that a request is for this server, and does not come from another page.

    Only the start page may be opened by a link on another page.
    """
    host = head.headers.get("host", "").lower()
    name, colon, port = host.partition(":")
    if name not in _NAMES or (colon and not (port.isascii() and port.isdecimal())):
        return False
    if head.headers.get("origin", f"http://{host}").lower() != f"http://{host}":
        return False
    if head.headers.get("sec-fetch-site", "none") in ("none", "same-origin"):
        return True
    # A link on another page may lead to our page.
    return head.path == "/" and head.method == "GET" and head.headers.get("sec-fetch-mode") == "navigate"


def _within_descriptors(connections: Connections) -> Connections:
    """Return ``connections`` with a lower maximum, if the system allows too few file descriptors.

    A connection needs a descriptor, and the process itself needs some.
    """
    with suppress(ImportError):
        import resource

        soft = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
        if soft != resource.RLIM_INFINITY:
            return replace(connections, most=max(1, min(connections.most, soft - _OTHER_DESCRIPTORS)))
    return connections


def _read_all(reader: socket.socket) -> None:
    with suppress(BlockingIOError):
        while reader.recv(4096):
            pass


class PlaygroundServer:
    """Serves the playground to this machine only, at ``127.0.0.1``; with port 0, at any free port.

    ``limit_s`` is the most seconds for an answer. ``connections`` limits the number of connections
    and their times. Raises TltlError, TLT0776, if the port is not available.
    """

    def __init__(self, port: int, limit_s: float = LIMIT_S, connections: Connections = PLAYGROUND) -> None:
        try:
            # This sets SO_REUSEADDR on POSIX, so a port is free again as soon as its server has ended.
            self._listener = socket.create_server((HOST, port))
        except OSError as error:
            title = f"cannot serve at {HOST}:{port}: {reason(error)}"
            help_ = "choose another port, or let the system choose one: `--port 0`"
            raise TltlError([Diagnostic("TLT0776", title, help=help_)]) from None
        self._listener.setblocking(False)
        self.server_address: tuple[str, int] = self._listener.getsockname()
        self.token = secrets.token_urlsafe(24)
        self.children = Children(limit_s)
        self.page = PageHandler(self.children, self.token)
        self.connections = OpenConnections(_within_descriptors(connections))
        self._loop = asyncio.SelectorEventLoop()
        self._retry_timer: asyncio.TimerHandle | None = None
        self._accepted: set[asyncio.Task[object]] = set()
        self._thread: Thread | None = None
        self._stopped = Event()
        self._stopped.set()

    @property
    def address(self) -> str:
        """The address of the page, which contains the secret token.

        The token is in the fragment of the URL, which browsers do not send.
        """
        return f"http://{HOST}:{self.server_address[1]}/#token={self.token}"

    def serve_forever(self) -> None:
        """Serve until :meth:`shutdown` is called, or Ctrl-C raises KeyboardInterrupt."""
        self._thread = current_thread()
        try:
            self._stopped.clear()
            self._loop.call_soon(self._watch_listener)
            if os.name == "nt":
                self._loop.call_soon(self._wake)
            with self._signals_wake_loop():
                try:
                    self._loop.run_forever()
                finally:
                    self._loop.remove_reader(self._listener)
                    self._loop.run_until_complete(self._end_all())
        finally:
            self._stopped.set()

    def shutdown(self) -> None:
        """Stop :meth:`serve_forever` if it runs in another thread, and wait until it ends.

        In the thread that called :meth:`serve_forever`, do nothing, because that call has returned
        already.
        """
        if self._thread is not current_thread() and not self._stopped.is_set():
            self._loop.call_soon_threadsafe(self._loop.stop)
            self._stopped.wait()

    def server_close(self) -> None:
        """Stop the server, free the port, and end the child processes and all pending work."""
        self.children.close()
        self.shutdown()
        self.page.close()
        self._listener.close()
        self._loop.close()

    def __enter__(self) -> PlaygroundServer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.server_close()

    # --- new connections ----------------------------------------------------------------------

    def _watch_listener(self) -> None:
        """Start accepting new connections."""
        if self._retry_timer is not None:
            self._retry_timer.cancel()
            self._retry_timer = None
        self._loop.add_reader(self._listener, self._accept)

    def _accept(self) -> None:
        try:
            client, _ = self._listener.accept()
        except (BlockingIOError, InterruptedError, ConnectionAbortedError):
            return
        except OSError:
            self._pause_accepting()
            return
        client.setblocking(False)
        connecting = self._loop.connect_accepted_socket(lambda: Connection(self.page, self.connections), client)
        task: asyncio.Task[object] = self._loop.create_task(connecting)
        self._accepted.add(task)
        task.add_done_callback(self._accepted.discard)
        task.add_done_callback(report_failure)

    def _pause_accepting(self) -> None:
        """Stop accepting connections for a while, because the process cannot open more file descriptors.

        If an open connection may be closed, close it, and accept connections again at once.
        Otherwise, do so after :data:`_AGAIN_S` seconds.
        """
        self._loop.remove_reader(self._listener)
        if self.connections.make_room():
            # The event loop closes that connection before it runs this callback.
            self._loop.call_soon(self._watch_listener)
        else:
            self._retry_timer = self._loop.call_later(_AGAIN_S, self._watch_listener)

    async def _end_all(self) -> None:
        """Close all connections, and cancel the tasks that answer their requests."""
        self.connections.close()
        tasks = asyncio.all_tasks() - {asyncio.current_task()}
        for task in tasks:
            task.cancel()
        await asyncio.gather(asyncio.sleep(0), *tasks, return_exceptions=True)

    @contextmanager
    def _signals_wake_loop(self) -> Iterator[None]:
        """Within the context, wake the event loop at each signal, so that the signal's handler runs at once.

        Python runs the handler of a signal between two steps of the main thread. Without this, a
        signal that another thread gets, or that comes just before the loop begins to wait, would
        not be handled until a request comes. In a thread other than the main thread, do nothing.
        """
        if current_thread() is not main_thread():
            yield
            return
        reader, writer = socket.socketpair()
        with reader, writer:
            for end in (reader, writer):
                end.setblocking(False)
            self._loop.add_reader(reader, _read_all, reader)
            # Remove the old descriptor before `try`, and set ours inside. If one call did both, an interrupt
            # right after it would leave our descriptor set, although it is closed below.
            before = signal.set_wakeup_fd(-1)
            try:
                signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
                yield
            finally:
                signal.set_wakeup_fd(before)
                self._loop.remove_reader(reader)

    def _wake(self) -> None:
        """Wake the event loop twice a second: on Windows, the loop notices Ctrl-C only when it is awake."""
        self._loop.call_later(0.5, self._wake)
