"""The errors of commands that need something that a game does not offer."""

from __future__ import annotations

from tltl_runtime.game.level import Level
from tltlc.api import Diagnostic, TltlError


def capability_error(level: Level, lack: str, advice: str) -> TltlError:
    """Return the error TLT0731: "the game of `LEVEL` draws no pictures", where ``lack`` is "draws no pictures".

    ``advice`` says what the user can do instead.
    """
    return TltlError([Diagnostic("TLT0731", f"the game of `{level.name}` {lack}", help=advice)])


def no_expert_error(level: Level) -> TltlError:
    """Return the error TLT0731, which says that the game of a level has no scripted expert."""
    advice = (
        "let a trained policy play and be recorded: `tltlc evaluate POLICY --record all --out DIR`, "
        "or play the tape of a person again: `tltlc record LEVEL --tape FILE`"
    )
    return capability_error(level, "has no scripted expert", advice)
