"""Run the language server, and handle the notifications of the editor."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import socket
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from inspect import iscoroutinefunction
from io import BufferedReader
from typing import Any, BinaryIO, Final, cast

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.io_ import StdoutWriter

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.diagnostics.shortening import shorten
from tltlc.interfaces.lsp.answers import ANSWERS, FILES_AND_FOLDERS, run_tests
from tltlc.interfaces.lsp.frames import Frames
from tltlc.interfaces.lsp.lenses import RUN_TESTS
from tltlc.interfaces.lsp.paths import location_at
from tltlc.interfaces.lsp.protocol import LOG, Protocol
from tltlc.interfaces.lsp.session import EditorSession

_REQUEST_FAILED: Final = -32803
"""The protocol's error code RequestFailed, for failures whose reason the user should read."""
_READ_SIZE: Final = 1 << 16
"""Bytes that are read at once."""
_CLOSED_PIPE: Final = 141
"""The exit status if the editor stops reading: 128 plus the number of SIGPIPE."""


def serve() -> bool:
    """Serve an editor over standard input and output until it exits.

    Return whether the editor sent ``shutdown`` before it exited or closed the connection.
    """
    # Use copies of both streams; everything else that this process prints goes to standard error.
    editor_input, editor_output = os.fdopen(os.dup(0), "rb"), _EditorOutput(os.fdopen(os.dup(1), "wb"))
    os.dup2(2, 1)
    # Log only errors of pygls: editors may cancel answered requests, and send unknown notifications.
    logging.getLogger("pygls").setLevel(logging.ERROR)
    for part in ("pygls.protocol.json_rpc", "pygls.server"):
        logging.getLogger(part).addFilter(_is_unforeseen)
    for number in (signal.SIGINT, signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else [])):
        if signal.getsignal(number) is not signal.SIG_IGN:
            # A thread waits for the editor's next line, and a normal exit of Python would wait for that thread.
            signal.signal(number, lambda number, _: os._exit(128 + number))
    server = create()
    cast("Protocol", server.protocol).set_writer(StdoutWriter(cast("BinaryIO", editor_output)))
    # The library raises SystemExit at the message `exit`.
    with suppress(SystemExit):
        try:
            asyncio.run(_listen(server, editor_input))
        finally:
            server.worker.abandon()
            server.shutdown()  # type: ignore[no-untyped-call]
    return server.was_shut_down


async def _listen(server: EditorSession, file: BufferedReader) -> None:
    """Read messages from ``file``, and handle them until the input ends."""
    frames, protocol = Frames(), cast("Protocol", server.protocol)
    loop = asyncio.get_running_loop()
    _wake_at_signals(loop)
    data = b"?"
    while data:
        data = await loop.run_in_executor(server.thread_pool, file.read1, _READ_SIZE)
        for frame in frames.feed(data) if data else frames.end():
            try:
                protocol.receive(frame)
            except Exception as error:
                LOG.exception("a message was not understood")
                server.report_server_error(error, JsonRpcException)
            # Let handlers run, for example to send an answer, before the next message is handled.
            await asyncio.sleep(0)


def _wake_at_signals(loop: asyncio.AbstractEventLoop) -> None:
    """Let each signal wake the event loop, so that Python calls the signal's handler at once.

    Otherwise, a signal that arrives just before the loop begins to wait, or in another thread, has
    no effect until the editor sends the next message. On Windows, the loop of asyncio does this
    itself.
    """
    if sys.platform == "win32":
        return
    waking, written = socket.socketpair()
    waking.setblocking(False)
    written.setblocking(False)
    signal.set_wakeup_fd(written.detach(), warn_on_full_buffer=False)
    loop.add_reader(waking, waking.recv, _READ_SIZE)


class _EditorOutput:
    """A writable file for the output to the editor; the process ends if the editor stops reading.

    After the message ``exit``, the file is closed, and later answers are dropped.
    """

    def __init__(self, file: BinaryIO) -> None:
        self._file = file

    def write(self, data: bytes) -> None:
        if not self._file.closed:
            self._file.write(data)

    def flush(self) -> None:
        if self._file.closed:
            return
        try:
            self._file.flush()
        except OSError:
            os._exit(_CLOSED_PIPE)

    def close(self) -> None:
        self.flush()
        self._file.close()


def _is_unforeseen(record: logging.LogRecord) -> bool:
    """Whether to log a record of pygls.

    It is False for what this server handles itself: for errors that it answers to the editor, and for messages that
    are not well-formed.
    """
    error = record.exc_info[1] if record.exc_info else None
    return not isinstance(error, JsonRpcException) and not record.msg.startswith("Unable to deserialize message")


def create() -> EditorSession:
    """Create a language server, and register its handlers for requests and notifications."""
    server = EditorSession()
    for method, handler, options in (*_NOTIFICATIONS, *ANSWERS):
        server.feature(method, options)(_with_error_answers(server, handler))
    server.command(RUN_TESTS)(partial(run_tests, server))
    return server


def _with_error_answers(server: EditorSession, handler: Callable[[EditorSession, Any], Any]) -> Callable[[Any], Any]:
    """Return a handler that calls ``handler``, and turns a TltlError into an error response to the editor.

    The returned handler also records that the user looks at the document of the message. This
    document is then analysed before others.
    """
    if iscoroutinefunction(handler):

        async def answer_in_steps(params: Any) -> Any:
            with _error_answers(server, params):
                return await handler(server, params)

        return answer_in_steps

    def answer(params: Any) -> Any:
        with _error_answers(server, params):
            return handler(server, params)

    return answer


@contextmanager
def _error_answers(server: EditorSession, params: Any) -> Iterator[None]:
    try:
        yield
    except TltlError as error:
        diagnostic = shorten(error.diagnostics[0])
        text = f"{diagnostic.title}; {diagnostic.help}" if diagnostic.help else diagnostic.title
        raise JsonRpcException(f"{text} ({diagnostic.code})", _REQUEST_FAILED) from None
    finally:
        # Record the look only now: the handler may have changed or closed a document that waited for its analysis.
        document = getattr(params, "text_document", None)
        if document is not None:
            server.queue.record_look(document.uri)


# --- notifications ------------------------------------------------------------------------------


def _on_initialized(server: EditorSession, _: types.InitializedParams) -> None:
    root = server.workspace.root_uri
    server.texts.folders = [location_at(uri) for uri in server.workspace.folders or ([root] if root else [])]
    capabilities = server.client_capabilities.workspace
    watching = capabilities.did_change_watched_files if capabilities else None
    if watching and watching.dynamic_registration:
        watchers = [types.FileSystemWatcher("**/*.tltl"), types.FileSystemWatcher("**/tltl.toml")]
        options = types.DidChangeWatchedFilesRegistrationOptions(watchers)
        registration = types.Registration("tltlc-files", types.WORKSPACE_DID_CHANGE_WATCHED_FILES, options)
        server.client_register_capability(types.RegistrationParams([registration]))


def _on_shutdown(server: EditorSession, _: None) -> None:
    server.shut_down()


def _on_open(server: EditorSession, params: types.DidOpenTextDocumentParams) -> None:
    item = params.text_document
    server.on_change(server.texts.put(item.uri, item.version, item.text))


def _on_change(server: EditorSession, params: types.DidChangeTextDocumentParams) -> None:
    if params.content_changes:
        item = params.text_document
        server.on_change(server.texts.put(item.uri, item.version, params.content_changes[-1].text))


def _on_close(server: EditorSession, params: types.DidCloseTextDocumentParams) -> None:
    touched = server.texts.close(params.text_document.uri)
    server.on_close(params.text_document.uri)
    server.on_change(touched)


def _on_watched_files(server: EditorSession, params: types.DidChangeWatchedFilesParams) -> None:
    # For open files, the text in the editor counts, saved or not.
    if not all(server.texts.is_open(change.uri) for change in params.changes):
        _on_files(server, params)


def _on_files(server: EditorSession, _: Any) -> None:
    server.on_change(server.texts.refresh())
    server.on_use_change(server.texts.open_uris())


def _on_folders(server: EditorSession, _: types.DidChangeWorkspaceFoldersParams) -> None:
    server.texts.folders = [location_at(uri) for uri in server.workspace.folders]


_NOTIFICATIONS: Final[tuple[tuple[str, Callable[[EditorSession, Any], Any], Any], ...]] = (
    (types.INITIALIZED, _on_initialized, None),
    (types.SHUTDOWN, _on_shutdown, None),
    (types.TEXT_DOCUMENT_DID_OPEN, _on_open, None),
    (types.TEXT_DOCUMENT_DID_CHANGE, _on_change, None),
    (types.TEXT_DOCUMENT_DID_CLOSE, _on_close, None),
    (types.WORKSPACE_DID_CHANGE_WATCHED_FILES, _on_watched_files, None),
    # File watchers are not notified about the sources in a folder that is renamed or deleted.
    (types.WORKSPACE_DID_RENAME_FILES, _on_files, FILES_AND_FOLDERS),
    (types.WORKSPACE_DID_DELETE_FILES, _on_files, FILES_AND_FOLDERS),
    (types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS, _on_folders, None),
)
