"""The policy that a training begins with, instead of random weights."""

from __future__ import annotations

import hashlib
from pathlib import Path

from tltl_runtime.policies.file import read_policy
from tltl_runtime.policies.policy import Policy
from tltl_runtime.training.files.run_file import InitialPolicy, resume_command
from tltlc.api import Diagnostic, TltlError


def initial_policy_of(path: Path, policy: Policy) -> InitialPolicy:
    """Describe ``policy``, read from the file ``path``, as the initial policy of a training."""
    card = policy.card
    return InitialPolicy(str(path), weights_hash(policy), card.level, card.variant, card.level_hash)


def weights_hash(policy: Policy) -> str:
    """Return the SHA-256, in hexadecimal, of a policy's weights and their names, as its file stores them."""
    digest = hashlib.sha256()
    for name, weight in sorted(policy.weights().items()):
        digest.update(name.encode() + b"\0" + weight.tobytes())
    return digest.hexdigest()


def read_initial_policy(initial: InitialPolicy, folder: Path) -> Policy:
    """Read the policy that the training in ``folder`` begins with.

    Raises:
        TltlError: TLT0940, the file no longer exists, or has other weights; the errors of
            ``read_policy``.
    """
    if not Path(initial.path).is_file():
        raise _changed_policy_error(
            f"`{initial.path}`, the policy that the training in `{folder}` begins with, is missing", folder
        )
    policy = read_policy(initial.path)
    if weights_hash(policy) != initial.weights:
        raise _changed_policy_error(
            f"the weights in `{initial.path}` have changed since the training in `{folder}` was started", folder
        )
    return policy


def _changed_policy_error(title: str, folder: Path) -> TltlError:
    again = resume_command(folder)
    help_ = f"put it back and continue with `{again}`, or say where it is now: `{again} --from POLICY`"
    return TltlError([Diagnostic("TLT0940", title, help=help_)])
