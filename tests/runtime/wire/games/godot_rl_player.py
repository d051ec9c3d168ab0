"""A player on a row of places that speaks the protocol of Godot RL Agents, as the plugin of a Godot game does.

Facts, from ``addons/godot_rl_agents/sync.gd`` of https://github.com/edbeeching/godot_rl_agents_plugin:

- the game reads ``--port=N`` (by default 11008), ``--env_seed=N`` and further options from its arguments, and connects
  to 127.0.0.1;
- a message is a length of four bytes, the lowest first, and JSON (``put_string`` of Godot's StreamPeer);
- it waits for ``handshake``, which it does not answer, then for ``env_info``, which it answers with a list of spaces,
  one for each agent, and ``agent_policy_names``;
- then it handles ``reset``, ``action``, ``call`` and ``close``; ``obs``, ``reward``, ``done`` and ``info`` are lists
  with one item for each agent; bytes of pictures are hexadecimal digits;
- when the connection ends, it quits.

Usage: python godot_rl_player.py --port=N [--host=127.0.0.1] [--length=5] [--agents=1] [--old] [--fault=WORD]
"""

from __future__ import annotations

import json
import socket
import sys
import threading
from typing import Any

OPTIONS = dict(word.lstrip("-").partition("=")[::2] for word in sys.argv[1:])
LENGTH = int(OPTIONS.get("length", "5"))
AGENTS = int(OPTIONS.get("agents", "1"))
FAULT = OPTIONS.get("fault", "")


class Game:
    """The player begins at the place 1 + seed mod 2, and the episode ends at the last place."""

    def __init__(self, connection: socket.socket) -> None:
        self.connection, self.place, self.ticks = connection, 0, 0

    def play(self) -> None:
        assert self.get()["type"] == "handshake"
        assert self.get()["type"] == "env_info"
        self.put(self.env_info())
        while True:
            message = self.get()
            if message["type"] == "close":
                return
            if message["type"] == "reset":
                self.place, self.ticks = 1 + int(OPTIONS.get("env_seed", "1")) % 2, 0
                self.put({"type": "reset", "obs": [self.obs()] * AGENTS, "info": [{}] * AGENTS})
            elif message["type"] == "action":
                self.move(message["action"][0])
                done = self.place >= LENGTH
                reply = {"obs": [self.obs()], "reward": [float(done)], "done": [done], "info": [{}]}
                self.put({"type": "step", **reply})
            elif message["type"] == "call":
                self.put({"type": "call", "returns": [None]})

    def env_info(self) -> dict[str, Any]:
        actions = {
            "move": {"size": 3, "action_type": "discrete"},
            "push": {"size": 2, "action_type": "continuous"},
        }
        parts = {
            "obs": {"size": [2], "space": "box"},
            "camera_2d": {"size": [1, 2, 3], "space": "box"},
            "level": {"size": 4, "space": "discrete"},
        }
        if "old" in OPTIONS:
            return {"type": "env_info", "observation_space": parts, "action_space": actions, "n_agents": AGENTS}
        lists = {"observation_space": [parts] * AGENTS, "action_space": [actions] * AGENTS}
        return {"type": "env_info", **lists, "n_agents": AGENTS, "agent_policy_names": ["shared_policy"] * AGENTS}

    def move(self, action: dict[str, Any]) -> None:
        assert set(action) == {"move", "push"}
        assert action["move"] in (0, 1, 2)
        assert len(action["push"]) == 2
        self.ticks += 1
        self.place = max(self.place + action["move"] - 1, 0)
        if FAULT == "exit":
            sys.exit("the hero fell out of the world")

    def obs(self) -> dict[str, Any]:
        # Godot has no whole numbers in JSON: it writes 2.0.
        picture = "zz" if FAULT == "hex" else bytes([self.place, 0, 0, 255, 0, 0]).hex()
        return {"obs": [float(self.place), float(self.ticks)], "camera_2d": picture, "level": 2.0}

    def put(self, message: dict[str, Any]) -> None:
        data = json.dumps(message).encode()
        if FAULT == "text":
            data = b"<html>"
        self.connection.sendall(len(data).to_bytes(4, "little") + data)

    def get(self) -> Any:
        return json.loads(self.exactly(int.from_bytes(self.exactly(4), "little")))

    def exactly(self, count: int) -> bytes:
        data = b""
        while len(data) < count:
            received = self.connection.recv(count - len(data))
            if not received:
                sys.exit(0)
            data += received
        return data


if __name__ == "__main__":
    if FAULT == "early":
        sys.exit("there is no display")
    if FAULT == "silent":
        threading.Event().wait()
    with socket.create_connection((OPTIONS.get("host", "127.0.0.1"), int(OPTIONS.get("port", "11008")))) as to_trainer:
        Game(to_trainer).play()
