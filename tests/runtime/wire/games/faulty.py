"""A game with one fault: python faulty.py FAULT [FILE]. It says on standard error what it is about to do."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, NoReturn

HELLO: dict[str, Any] = {
    "tltl": 1,
    "name": "faulty",
    "signals": {"health": {"range": [0, 1]}, "seen": {"type": "bool"}},
    "actions": {"type": "discrete", "n": 2},
    "capabilities": ["snapshot"],
}
STATE: dict[str, Any] = {"state": {"signals": {"health": 1, "seen": False}}}

ANSWERS: dict[str, bytes] = {
    "garbage": b"Godot Engine v3.2.3 - https://godotengine.org\n",
    "binary": b"\xff\x00\xfe\n",
    "nan": b'{"state": {"signals": {"health": NaN, "seen": false}}}\n',
    "infinite": b'{"state": {"signals": {"health": 1e999, "seen": false}}}\n',
    "wrong type": b'{"state": {"signals": {"health": "full", "seen": false}}}\n',
    "number for bool": b'{"state": {"signals": {"health": 1, "seen": 1}}}\n',
    "out of range": b'{"state": {"signals": {"health": 2, "seen": false}}}\n',
    "other signal": b'{"state": {"signals": {"health": 1, "seen": false, "armour": 3}}}\n',
    "missing signal": b'{"state": {"signals": {"health": 1}}}\n',
    "other kind": b'{"snapshot": {"id": 3}}\n',
    "error": b'{"error": {"message": "the scene `crypt` cannot be loaded"}}\n',
    "early cause": b'{"state": {"signals": {"health": 1, "seen": false}, "ended": false, "cause": "guard"}}\n',
    "two answers": b'{"state": {"signals": {"health": 1, "seen": false}}}\n' * 2,
}


def say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def hang() -> NoReturn:
    """Never end by itself, and ignore what can be ignored."""
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    while True:
        time.sleep(3600)


def act(fault: str, connection: socket.socket, file: str) -> None:
    """Do in place of an answer what the fault is; note in the file that it begins."""
    say(f"now: {fault}")
    if file:
        Path(file).touch()
    if fault == "hang":
        hang()
    elif fault == "exit":
        sys.exit(3)
    elif fault == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    elif fault == "raise":
        raise RuntimeError("no such node: Player/Camera")
    elif fault == "close":
        connection.shutdown(socket.SHUT_RDWR)
        hang()
    elif fault == "long line":
        for _ in range(1024):
            connection.sendall(b"x" * (1 << 20))
    elif fault == "stop":
        os.kill(os.getpid(), signal.SIGSTOP)
    elif fault == "flood":
        for _ in range(256):
            os.write(2, b"x" * (1 << 20))
        sys.exit(4)
    elif fault == "drip":
        while True:
            connection.sendall(b"x")
            time.sleep(0.01)
    else:
        connection.sendall(ANSWERS[fault])


def main(fault: str, file: str = "") -> None:
    hello = {**HELLO, "token": os.environ["TLTL_TOKEN"]}
    if fault == "no hello":
        say("loading assets")
        hang()
    if fault in ("script error", "late hello"):
        say("error: XDG_RUNTIME_DIR is invalid or not set in the environment.")
        say("SCRIPT ERROR: GDScript::reload: Parse Error: Expected an indented block.\n   At: res://main.gd:7.")
        say("ERROR: reload: Method failed.\n   At: modules/gdscript/gdscript.cpp:599.")
    if fault == "script error":
        hang()
    if fault == "exit first":
        say("cannot open display :0")
        sys.exit(1)
    if fault == "old version":
        hello["tltl"] = 0
    if fault == "wrong token":
        hello["token"] = "guessed"
    if fault == "wrong actions":
        hello["actions"] = {"type": "discret", "n": 2}
    if fault == "changes":
        # From the second start on, the game declares another signal.
        if Path(file).exists():
            hello["signals"] = {**hello["signals"], "armour": {}}
        Path(file).touch()
    if fault == "children":
        # One in the process group, one in a session of its own, whose parent has ended.
        stay = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(3600)"
        child = subprocess.Popen([sys.executable, "-c", stay])
        start = f"import subprocess, sys; print(subprocess.Popen([sys.executable, '-c', {stay!r}], start_new_session=True, stdout=-3, stderr=-3).pid)"  # noqa: E501
        orphan = subprocess.run([sys.executable, "-c", start], capture_output=True, check=True, text=True)
        Path(file).write_text(f"{os.getpid()} {child.pid} {orphan.stdout}")
    connection = socket.create_connection(("127.0.0.1", int(os.environ["TLTL_PORT"])))
    lines = connection.makefile("rb")
    if fault == "long hello":
        act("long line", connection, "")
    if fault == "drip hello":
        act("drip", connection, "")
    first = b"Loading...\n" if fault == "garbage first" else json.dumps({"hello": hello}).encode() + b"\n"
    connection.sendall(first)
    at_step = fault.removeprefix("step ")
    while line := lines.readline():
        request = json.loads(line)
        if "error" in request:
            say(request["error"]["message"])
            sys.exit(2)
        if fault == "second connection":
            try:
                socket.create_connection(("127.0.0.1", int(os.environ["TLTL_PORT"])))
            except OSError as error:
                say(f"second connection: {type(error).__name__}")
                sys.exit(5)
        if "close" in request:
            return
        if (fault != at_step) == ("step" in request) and fault not in ("changes", "children", "none", "late hello"):
            act(at_step, connection, file)
        else:
            connection.sendall(json.dumps(STATE).encode() + b"\n")
    if fault == "children":
        hang()


if __name__ == "__main__":
    main(*sys.argv[1:])
