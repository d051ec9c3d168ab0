"""A client of the language server protocol, for tests.

Its server never abandons an analysis, and the analysis of
:data:`tests.interfaces.lsp.texts.ENDLESS` never ends. So a test that waits for such an analysis
hangs, and no other test depends on time.
"""

from __future__ import annotations

import json
import os
import queue
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.waiting import HANG_S, until

ROOT = Path(__file__).parents[3]
PROGRAM = f"""
import sys
sys.path.insert(0, {str(ROOT)!r})
from tltlc.interfaces.lsp import answers, worker
worker.LONGEST_S = {10 * HANG_S}
from tltlc.interfaces.cli.main import main
main(['lsp'])
"""


class RefusedError(Exception):
    """The server answered with an error."""


class Client:
    def __init__(self, folder: Path | None = None, encodings: tuple[str, ...] = (), **capabilities: Any) -> None:
        path = [str(Path(__file__).with_name("endless")), *sys.path]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path)}
        # The file lies beside the folder, which must contain only the files of the test.
        self._analyses_file = folder.with_name(f"{folder.name}.begun") if folder else None
        if self._analyses_file:
            self._analyses_file.touch()
            environment["BEGUN"] = str(self._analyses_file)
        self.process = subprocess.Popen(
            [sys.executable, "-c", PROGRAM],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
        )
        self.messages: queue.Queue[dict[str, Any]] = queue.Queue()
        self.received: list[dict[str, Any]] = []
        self.errors: list[str] = []
        self._number = 0
        self._first_unread = 0
        """The index in ``received`` of the first message after the last notification or the last diagnostics."""
        threading.Thread(target=self._read, daemon=True).start()
        self._listening = threading.Thread(target=self._read_errors, daemon=True)
        self._listening.start()
        general = {"positionEncodings": list(encodings)} if encodings else {}
        folders = [{"uri": folder.as_uri(), "name": folder.name}] if folder else None
        self.capabilities = self.ask(
            "initialize",
            {
                "processId": None,
                "rootUri": folder.as_uri() if folder else None,
                "workspaceFolders": folders,
                "capabilities": {"general": general, **capabilities},
            },
        )["capabilities"]
        self.tell("initialized", {})

    # --- messages -----------------------------------------------------------------------------

    def tell(self, method: str, params: Any) -> None:
        self._first_unread = len(self.received)
        self._send({"method": method, "params": params})

    def start(self, method: str, params: Any) -> int:
        """Send a request without waiting for the answer, and return its number."""
        self._number += 1
        self._send({"id": self._number, "method": method, "params": params})
        return self._number

    def ask(self, method: str, params: Any) -> Any:
        answer = self.answer(self.start(method, params))
        if "error" in answer:
            raise RefusedError(answer["error"]["message"])
        return answer["result"]

    def answer(self, number: int) -> dict[str, Any]:
        """Return the answer to a request, which has already arrived or will arrive."""

        def is_answer(message: dict[str, Any]) -> bool:
            return message.get("id") == number and "method" not in message

        return next(filter(is_answer, self.received), None) or self._next(is_answer)

    def diagnostics(self, uri: str, wanted: Callable[[list[Any]], bool] = lambda _: True) -> list[dict[str, Any]]:
        """Return the next diagnostics of a document for which ``wanted`` is true, since the last notification.

        They may have come before the answer to a request that was sent after the notification.
        """

        def is_wanted(message: dict[str, Any]) -> bool:
            return (
                message.get("method") == "textDocument/publishDiagnostics"
                and message["params"]["uri"] == uri
                and wanted(message["params"]["diagnostics"])
            )

        for index in range(self._first_unread, len(self.received)):
            if is_wanted(message := self.received[index]):
                self._first_unread = index + 1
                break
        else:
            message = self._next(is_wanted)
            self._first_unread = len(self.received)
        diagnostics: list[dict[str, Any]] = message["params"]["diagnostics"]
        return diagnostics

    def published(self, uri: str) -> list[list[dict[str, Any]]]:
        """Return all lists of diagnostics published for a document so far, in order."""
        published = [
            message["params"] for message in self.received if message.get("method") == "textDocument/publishDiagnostics"
        ]
        return [params["diagnostics"] for params in published if params["uri"] == uri]

    def is_quiet(self, seconds: float) -> bool:
        """Whether no message arrives for a while. Only for measurements; no test may depend on time."""
        try:
            self.received.append(self.messages.get(timeout=seconds))
        except queue.Empty:
            return True
        return False

    def wait_for_analyses(self, number: int = 1) -> None:
        """Wait until the server has started this many endless analyses."""

        def has_begun() -> bool:
            assert self._analyses_file, "a client without a folder has no such analyses"
            assert self.process.poll() is None, self.errors
            return self._analyses_file.read_text(encoding="utf-8").count("\n") >= number

        until(has_begun, "an analysis")

    def message(self, method: str) -> Any:
        """Return the params of the last message with this method; if there is none yet, wait for
        one."""
        earlier = [message for message in self.received if message.get("method") == method]
        return (earlier or [self._next(lambda message: message.get("method") == method)])[-1]["params"]

    # --- documents ----------------------------------------------------------------------------

    def open(self, path: Path | str, text: str) -> str:
        uri = path.as_uri() if isinstance(path, Path) else path
        item = {"uri": uri, "languageId": "tltl", "version": 1, "text": text}
        self.tell("textDocument/didOpen", {"textDocument": item})
        return uri

    def change(self, uri: str, text: str, version: int = 2) -> None:
        params = {"textDocument": {"uri": uri, "version": version}, "contentChanges": [{"text": text}]}
        self.tell("textDocument/didChange", params)

    def at(self, method: str, uri: str, text: str, mark: str, **more: Any) -> Any:
        """Send a request for the position of a mark, which occurs once in the text."""
        params = {"textDocument": {"uri": uri}, "position": place(text, text.index(mark)), **more}
        return self.ask(f"textDocument/{method}", params)

    def close(self) -> int:
        self.ask("shutdown", None)
        self.tell("exit", None)
        return self.process.wait(HANG_S)

    def kill(self) -> None:
        self.process.kill()
        self.process.wait(HANG_S)

    def stop_reading(self) -> None:
        """Close the server's standard output, as a crashed editor does."""
        assert self.process.stdout
        os.dup2(os.open(os.devnull, os.O_RDONLY), self.process.stdout.fileno())

    def wait_for_processes(self) -> None:
        """Wait until all processes started by the server have ended; they share its standard error."""
        self._listening.join(HANG_S)
        assert not self._listening.is_alive()

    # --- underneath ---------------------------------------------------------------------------

    def _send(self, message: dict[str, Any]) -> None:
        data = json.dumps({"jsonrpc": "2.0", **message}).encode()
        assert self.process.stdin
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(data) + data)
        self.process.stdin.flush()

    def _next(self, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        end = time.monotonic() + HANG_S
        while True:
            remaining = end - time.monotonic()
            assert remaining > 0, f"no such message came; the server said {self.errors}"
            try:
                message = self.messages.get(timeout=min(remaining, 1.0))
            except queue.Empty:
                assert self.process.poll() is None, f"the server has ended: {''.join(self.errors)}"
                continue
            if "id" in message and "method" in message:
                self._send({"id": message["id"], "result": None})
            self.received.append(message)
            if wanted(message):
                return message

    def _read(self) -> None:
        stream = self.process.stdout
        assert stream
        while True:
            length = 0
            while line := stream.readline().strip():
                name, _, value = line.partition(b":")
                if name.lower() == b"content-length":
                    length = int(value)
            if not length:
                return
            self.messages.put(json.loads(stream.read(length)))

    def _read_errors(self) -> None:
        assert self.process.stderr
        for line in self.process.stderr:
            self.errors.append(line.decode())


def place(text: str, offset: int, encoding: str = "utf-16") -> dict[str, int]:
    """Return the position of a character, as the protocol defines it."""
    before = text[:offset].replace("\r\n", "\n")
    line = before.rpartition("\n")[2]
    width = {"utf-8": 1, "utf-16": 2, "utf-32": 4}[encoding]
    units = len(line.encode({"utf-8": "utf-8", "utf-16": "utf-16-le", "utf-32": "utf-32-le"}[encoding])) // width
    return {"line": before.count("\n"), "character": units}
