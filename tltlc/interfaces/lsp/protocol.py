"""Handle the messages of an editor, even malformed ones.

A malformed message is logged, and answered with an error if it may be a request. It does not
affect the next message.
"""

from __future__ import annotations

import json
import logging
from typing import Any, Final

from cattrs import transform_error
from lsprotocol import types
from pygls.exceptions import (
    JsonRpcException,
    JsonRpcInvalidParams,
    JsonRpcInvalidRequest,
    JsonRpcParseError,
    JsonRpcServerNotInitialized,
)
from pygls.protocol import LanguageServerProtocol

from tltlc.interfaces.lsp.frames import Fault, MessageFrame

LOG: Final = logging.getLogger("tltlc.interfaces.lsp")
"""Logs to standard error, which editors show as the server's log."""
_ANSWERS: Final = {"result", "error"}
_NOTEBOOK_METHODS: Final = "notebookDocument/"


class Protocol(LanguageServerProtocol):
    """The protocol of pygls, extended so that malformed messages are answered, too."""

    def receive(self, frame: MessageFrame) -> None:
        """Handle a frame: parse and handle the body of a message, or answer or log a fault of headers."""
        if isinstance(frame, Fault):
            if frame.is_answered:
                self.refuse(None, JsonRpcInvalidRequest(frame.text))
            else:
                LOG.warning("%s", frame.text)
            return
        try:
            message = json.loads(frame.data)
        except (ValueError, RecursionError) as error:
            # ValueError: broken JSON, bytes that are not text, or numbers with thousands of digits.
            self.refuse(None, JsonRpcParseError.of(error))
        else:
            self.handle_message(message)

    def handle_message(self, message: Any) -> None:
        """Check a message, then handle it; refuse it if it is malformed."""
        try:
            structured = self._parse(message)
        except JsonRpcException as error:
            self.refuse(message, error)
        else:
            super().handle_message(structured)

    def refuse(self, message: Any, error: JsonRpcException) -> None:
        """Refuse a message: log the error, and send it to the editor as the answer to the message.

        A message that is a notification or itself an answer gets no answer.
        """
        content = message if isinstance(message, dict) else {}
        LOG.warning("a message was refused (method: %s): %s", content.get("method"), error)
        if ("id" in content or "method" not in content) and not content.keys() & _ANSWERS:
            number = content.get("id")
            error_content = {"code": error.code, "message": error.message}
            self._send_data({"jsonrpc": self.VERSION, "id": number if _is_id(number) else None, "error": error_content})

    def _parse(self, message: Any) -> Any:
        if not isinstance(message, dict) or message.get("jsonrpc") != self.VERSION:
            raise JsonRpcInvalidRequest("this is not a message of JSON-RPC 2.0")
        if "method" in message:
            self._check_request(message)
        elif not _is_id(message.get("id", "")) and message["id"] is not None:
            raise JsonRpcInvalidRequest("an id must be a whole number or a text")
        elif "id" not in message or not message.keys() & _ANSWERS:
            raise JsonRpcInvalidRequest("this is neither a request nor an answer")
        try:
            structured = self.structure_message(message)
        except JsonRpcException as error:
            raise JsonRpcInvalidParams("; ".join(transform_error(error.__cause__ or error))) from None
        if isinstance(structured, types.ExecuteCommandRequest) and structured.params.arguments is None:
            # pygls counts the arguments, so it needs a list.
            structured.params.arguments = []
        if isinstance(structured, types.DidChangeTextDocumentNotification):
            uri = structured.params.text_document.uri
            if uri not in self.workspace.text_documents:
                raise JsonRpcInvalidParams(f"cannot change a document that is not open: {uri}")
        return structured

    def _check_request(self, message: dict[str, Any]) -> None:
        """Raise JsonRpcException if a request or notification is malformed or comes at a wrong time.

        If the method is unknown and the message has no params, set its params to None.
        """
        method = message["method"]
        if not isinstance(method, str) or ("id" in message and not _is_id(message["id"])):
            raise JsonRpcInvalidRequest("a method must be a text, and an id must be a whole number or a text")
        if method == types.CANCEL_REQUEST and not _has_id(message.get("params")):
            raise JsonRpcInvalidParams("an id must be a whole number or a text")
        if method.startswith(_NOTEBOOK_METHODS):
            raise JsonRpcInvalidRequest("notebooks are not supported, as the server has said at its start")
        if method == types.INITIALIZE and self._workspace is not None:
            raise JsonRpcInvalidRequest("the server is already initialized")
        if method not in (types.INITIALIZE, types.EXIT) and self._workspace is None:
            raise JsonRpcServerNotInitialized(f"`{method}` came before `{types.INITIALIZE}`")
        if method != types.EXIT and self._shutdown:
            raise JsonRpcInvalidRequest(f"`{method}` came after `{types.SHUTDOWN}`")
        if self.get_message_type(method) is None:
            # A message with an unknown method may lack params. With them, pygls reports the unknown method.
            message.setdefault("params", None)


def _has_id(params: Any) -> bool:
    return isinstance(params, dict) and _is_id(params.get("id"))


def _is_id(number: Any) -> bool:
    return isinstance(number, (int, str))
