"""Addresses at which tltlc cannot wait for a game of another trainer."""

from __future__ import annotations

import socket

import pytest

from tests.runtime.wire.test_faults import GAMES
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.wire_game import GODOT_RL, ML_AGENTS, WireGame
from tltlc.api import Diagnostic


@pytest.fixture(name="trainer", params=[(GODOT_RL, "Godot RL Agents"), (ML_AGENTS, "`mlagents-learn`")])
def _trainer(request: pytest.FixtureRequest) -> tuple[str, str]:
    """A protocol, and the program that also speaks it."""
    protocol, program = request.param
    if protocol == ML_AGENTS:
        pytest.importorskip("grpc", reason="needs grpcio")
        pytest.importorskip("google.protobuf", reason="needs protobuf")
    return protocol, program


def refusal(place: str, protocol: str) -> Diagnostic:
    """Return what is reported if tltlc waits for a game at ``place``."""
    with pytest.raises(WireError, match=f"TLT0790: cannot wait for a game at `{place}`: ") as caught:
        WireEnv(WireGame("row", GAMES, connect=place, protocol=protocol))
    (diagnostic,) = caught.value.diagnostics
    return diagnostic


def test_the_port_of_another_program_is_reported(trainer: tuple[str, str]) -> None:
    protocol, program = trainer
    with socket.create_server(("127.0.0.1", 0)) as server:
        error = refusal(f"127.0.0.1:{server.getsockname()[1]}", protocol)
    assert "in use" in error.title
    assert error.help == f"end the other program that uses this port; it may be another tltlc, or {program}"


def test_an_address_of_another_machine_is_reported(trainer: tuple[str, str]) -> None:
    error = refusal("192.0.2.1:5000", trainer[0])  # This address is for documentation only.
    assert (error.help or "").startswith("in the game file, give `connect` an address of this machine")
