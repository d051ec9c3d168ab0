"""The errors of commands that need what a game does not offer."""

from __future__ import annotations

from tltl_runtime.game.level import Level
from tltlc.api import Diagnostic, TltlError


def capability_error(level: Level, lack: str, advice: str) -> TltlError:
    """Return TLT0731: the game of a level lacks something, for example it "draws no pictures".

    ``advice`` says what the user can do instead.
    """
    return TltlError([Diagnostic("TLT0731", f"the game of `{level.name}` {lack}", help=advice)])


def no_expert_error(level: Level) -> TltlError:
    """Return TLT0731: the game of a level has no scripted expert."""
    advice = "let a trained policy play and be recorded: `tltlc evaluate POLICY --record all --out DIR`"
    return capability_error(level, "has no scripted expert", advice)
