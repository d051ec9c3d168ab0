"""The counter game over WebSocket, as a page would play it: python web.py [FAULT]."""

from __future__ import annotations

import json
import os
import sys
from typing import Any

import counter  # type: ignore[import-not-found]
import tltl_client  # type: ignore[import-not-found]
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect


class WebClient:
    """What ``tltl_client.Client`` is, over WebSocket."""

    request = tltl_client.Client.request
    answer_state = tltl_client.Client.answer_state
    refuse = tltl_client.Client.refuse

    def __init__(self, hello: dict[str, Any], fault: str) -> None:
        self.connection = connect(f"ws://127.0.0.1:{os.environ['TLTL_PORT']}", compression=None, max_size=1 << 25)
        self.fault = fault
        token = "guessed" if fault == "token" else os.environ["TLTL_TOKEN"]
        self.answer({"hello": {"tltl": 1, "token": token, **hello}})

    def answer(self, message: Any) -> None:
        data = json.dumps(message)
        if "hello" not in message and self.fault == "long":
            data = "x" * (1 << 26)
        pieces = [data[:7], data[7:]] if self.fault == "pieces" else data
        self.connection.send(pieces)

    def close(self) -> None:
        self.connection.close()

    def _read(self) -> Any:
        try:
            return json.loads(self.connection.recv())
        except ConnectionClosed:
            raise tltl_client.Disconnected from None


if __name__ == "__main__":
    game = counter.Counter()
    tltl_client.play(game, WebClient(tltl_client.game_hello(game), *sys.argv[1:] or ("",)))
