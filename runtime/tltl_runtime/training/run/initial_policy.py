"""The policy that a training begins with, in place of weights that are drawn."""

from __future__ import annotations

import hashlib
from pathlib import Path

from tltl_runtime.policies.file import read_policy
from tltl_runtime.policies.policy import Policy
from tltl_runtime.training.run.run import Initial, resume_command
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


def initial_of(path: Path, policy: Policy) -> Initial:
    """What a training that begins with ``policy``, from the file ``path``, records of it."""
    card = policy.card
    return Initial(str(path), weights_hash(policy), card.level, card.variant, card.level_hash)


def weights_hash(policy: Policy) -> str:
    """SHA-256, in hexadecimal, of the weights as a file holds them, and of their names."""
    found = hashlib.sha256()
    for name, each in sorted(policy.weights().items()):
        found.update(name.encode() + b"\0" + each.numpy().tobytes())
    return found.hexdigest()


def read_initial(initial: Initial, folder: Path) -> Policy:
    """The policy that the training in ``folder`` begins with.

    Raises:
        TltlError: TLT0940, it is not there any more, or has other weights; what is wrong with its file.
    """
    if not Path(initial.path).is_file():
        raise _gone(f"`{initial.path}` is not there, with which the training in `{folder}` begins", folder)
    policy = read_policy(initial.path)
    if weights_hash(policy) != initial.weights:
        raise _gone(
            f"`{initial.path}` is another policy now than when the training in `{folder}` was asked for", folder
        )
    return policy


def _gone(title: str, folder: Path) -> TltlError:
    again = resume_command(folder)
    help_ = f"put it back and go on by `{again}`, or say where it is now: `{again} --from POLICY`"
    return TltlError([Diagnostic("TLT0940", title, help=help_)])
