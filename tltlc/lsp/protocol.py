"""What an editor sends, also where it is wrong: requests are answered, all else is logged, and what follows counts."""

from __future__ import annotations

import json
import logging
import re
from typing import Any, BinaryIO, Final

from cattrs import transform_error
from lsprotocol import types
from pygls.exceptions import (
    JsonRpcException,
    JsonRpcInvalidParams,
    JsonRpcInvalidRequest,
    JsonRpcServerNotInitialized,
)
from pygls.protocol import LanguageServerProtocol

LOG: Final = logging.getLogger("tltlc.lsp")
"""Goes to standard error, which editors show in a log of the server."""
UNREADABLE: Final = (json.JSONDecodeError, UnicodeDecodeError, RecursionError)
"""What reading a text as JSON may fail with."""

# Behind a message whose length is wrong, the next header does not begin its line. What is longer is no length.
_LENGTH: Final = re.compile(rb"Content-Length:[ \t]*([0-9]{1,9})[ \t]*\r?\n\Z", re.IGNORECASE)
_ANSWERS: Final = {"result", "error"}
_OTHER_HEADER: Final = re.compile(rb"Content-Type:", re.IGNORECASE)


class Incoming:
    """What the editor sends, with headers as the library knows them; the protocol lets editors write them otherwise."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self.read = file.read

    def readline(self) -> bytes:
        """The next line of a header; of those that say nothing, only that they are there."""
        line = self._file.readline()
        length = _LENGTH.search(line)
        lost = line[: length.start()] if length else line
        if lost.strip() and not _OTHER_HEADER.match(lost):
            LOG.warning("a message without a header `Content-Length` is passed over: %.60r", lost)
        if length is not None:
            return b"Content-Length: %s\r\n" % length[1]
        return b"passed over\r\n" if lost.strip() else line


class Protocol(LanguageServerProtocol):
    """The library's protocol, which looks at a message as a whole, so that it can answer those that are wrong."""

    def structure_message(self, data: dict[str, Any]) -> Any:
        """Leave the parts of a message as they are, which pass here one by one."""
        return data

    def handle_message(self, message: Any) -> None:
        """Have a message answered."""
        try:
            understood = self._understood(message)
        except JsonRpcException as error:
            self.refuse(message, error)
        else:
            super().handle_message(understood)

    def refuse(self, message: Any, error: JsonRpcException) -> None:
        """Say what is wrong with a message: to who waits for an answer, or cannot be known; else in the log."""
        content = message if isinstance(message, dict) else {}
        LOG.warning("a message was refused (method: %s): %s", content.get("method"), error)
        if ("id" in content or "method" not in content) and not content.keys() & _ANSWERS:
            number = content.get("id")
            told = {"code": error.code, "message": error.message}
            self._send_data({"jsonrpc": self.VERSION, "id": number if _is_id(number) else None, "error": told})

    def _understood(self, message: Any) -> Any:
        if not isinstance(message, dict) or message.get("jsonrpc") != self.VERSION:
            raise JsonRpcInvalidRequest("this is no message of JSON-RPC 2.0")
        if "method" in message:
            self._check_request(message)
        elif "id" not in message or not message.keys() & _ANSWERS:
            raise JsonRpcInvalidRequest("this is neither a request nor an answer")
        try:
            understood = super().structure_message(message)
        except JsonRpcException as error:
            raise JsonRpcInvalidParams("; ".join(transform_error(error.__cause__ or error))) from None
        if isinstance(understood, types.ExecuteCommandRequest) and understood.params.arguments is None:
            # So that the library counts them.
            understood.params.arguments = []
        if isinstance(understood, types.DidChangeTextDocumentNotification):
            uri = understood.params.text_document.uri
            if uri not in self.workspace.text_documents:
                raise JsonRpcInvalidParams(f"a document was changed that is not open: {uri}")
        return understood

    def _check_request(self, message: dict[str, Any]) -> None:
        """Whether a request, or what an editor tells, has a form, and comes at a time, at which it can be looked at."""
        method = message["method"]
        if not isinstance(method, str) or ("id" in message and not _is_id(message["id"])):
            raise JsonRpcInvalidRequest("a method is a text, an id is a number or a text")
        if method == types.INITIALIZE and self._workspace is not None:
            raise JsonRpcInvalidRequest("the server is initialized already")
        if method not in (types.INITIALIZE, types.EXIT) and self._workspace is None:
            raise JsonRpcServerNotInitialized(f"`{method}` came before `{types.INITIALIZE}`")
        if method != types.EXIT and self._shutdown:
            raise JsonRpcInvalidRequest(f"`{method}` came after `{types.SHUTDOWN}`")
        if self.get_message_type(method) is None:
            # What is unknown may have none, and the library says that it is unknown.
            message.setdefault("params", None)


def _is_id(number: Any) -> bool:
    return isinstance(number, (int, str))
