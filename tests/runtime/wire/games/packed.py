"""A game that asks for MessagePack, and uses it if tltlc agrees: python packed.py [FAULT]."""

from __future__ import annotations

import json
import os
import socket
import sys
from typing import Any

import msgpack

STATE: dict[str, Any] = {
    "state": {
        "signals": {"health": 0.5},
        "observation": {"bytes": bytes(range(12)), "dtype": "uint8", "shape": [2, 2, 3]},
    }
}
FAULTS: dict[str, bytes] = {
    "long": (1 << 30).to_bytes(4, "big"),
    "garbage": (1).to_bytes(4, "big") + b"\xc1",
    "nan": msgpack.packb({"state": {"signals": {"health": float("nan")}}}),
    "extension": msgpack.packb({"state": {"signals": {"health": msgpack.ExtType(5, b"x")}}}),
}


def main(fault: str = "") -> None:
    connection = socket.create_connection(("127.0.0.1", int(os.environ["TLTL_PORT"])))
    stream = connection.makefile("rwb", buffering=1 << 16)
    hello = {
        "tltl": 1,
        "token": os.environ["TLTL_TOKEN"],
        "name": "packed",
        "encoding": "msgpack",
        "signals": {"health": {"range": [0, 1]}},
        "actions": {"type": "box", "low": -1, "high": 1, "shape": [2]},
        "observation": {"type": "box", "low": 0, "high": 255, "shape": [2, 2, 3], "dtype": "uint8"},
    }
    connection.sendall(json.dumps({"hello": hello}).encode() + b"\n")
    agreed = json.loads(stream.readline())["hello"]["encoding"]
    print(f"agreed: {agreed}", file=sys.stderr, flush=True)
    if agreed == "json":
        sys.exit(7)
    while head := stream.read(4):
        request = msgpack.unpackb(stream.read(int.from_bytes(head, "big")))
        if "close" in request:
            return
        data = FAULTS.get(fault) or msgpack.packb(STATE)
        framed = data if fault in ("long", "garbage") else len(data).to_bytes(4, "big") + data
        connection.sendall(framed)


if __name__ == "__main__":
    main(*sys.argv[1:])
