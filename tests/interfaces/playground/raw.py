"""Send raw bytes to a server, and read its answers."""

from __future__ import annotations

import re
import socket

from tests.waiting import HANG_S
from tltlc.interfaces.playground.server import PlaygroundServer


def connect(server: PlaygroundServer) -> socket.socket:
    return socket.create_connection(("127.0.0.1", server.server_address[1]), timeout=HANG_S)


def read_to_end(connection: socket.socket) -> bytes:
    """Read everything until the server closes the connection."""
    received = b""
    while chunk := connection.recv(1 << 16):
        received += chunk
    return received


def statuses(answers: bytes) -> list[int]:
    """Return the status codes of consecutive answers."""
    codes = []
    while answers:
        head, _, rest = answers.partition(b"\r\n\r\n")
        status = re.match(rb"HTTP/1\.1 (\d{3}) ", head)
        assert status, answers[:80]
        length = re.search(rb"\r\nContent-Length: (\d+)", head)
        codes.append(int(status[1]))
        answers = rest[int(length[1]) if length else 0 :]
    return codes


def statuses_until_closed(server: PlaygroundServer, data: bytes) -> list[int]:
    """Return the status codes if the server closes the connection itself."""
    with connect(server) as connection:
        connection.sendall(data)
        return statuses(read_to_end(connection))
