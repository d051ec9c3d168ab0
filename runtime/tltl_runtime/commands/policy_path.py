"""The policy that a command is to take: a file, or that of the training in a folder."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import Final

from tltl_runtime.training.metrics import METRICS, read_metrics
from tltl_runtime.training.run import POLICY, RUN
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

_MOST_NAMED: Final = 8
"""Of the trainings in a folder, as many are named."""


def policy_path(path: Path) -> Path:
    """The file of a policy: ``path``, or the one in this folder, which is there.

    Raises:
        TltlError: TLT0872, there is no policy in the folder; TLT0001, what a training there measured cannot be read.
    """
    if not path.is_dir():
        return path
    if (path / POLICY).exists():
        return path / POLICY
    if (path / RUN).exists():
        title = f"the training in `{path}` has no policy yet: {progress(path)}"
        help_ = f"`tltlc train --resume {quote(str(path))}` goes on until it has one; one that is going on has it soon"
    elif trainings := _trainings(path):
        named = ", ".join(f"`{each}`" for each in trainings[:_MOST_NAMED])
        more = f" and {len(trainings) - _MOST_NAMED} more" if len(trainings) > _MOST_NAMED else ""
        title, help_ = f"`{path}` holds trainings, and is none itself", f"name one of them: {named}{more}"
    else:
        title = f"there is neither a training nor a policy in `{path}`"
        help_ = "name a .safetensors file, or the folder that `tltlc train` named when it ended"
    raise TltlError([Diagnostic("TLT0872", title, help=help_)])


def progress(folder: Path) -> str:
    """How far the training in a folder is, in words; raises TltlError, TLT0001, where its file cannot be read."""
    measured = read_metrics(folder / METRICS)
    if not measured:
        return "its first iteration is not over"
    episodes = sum(each["episodes"] for each in measured)
    return f"after {measured[-1]['steps']:,} steps, {episodes or 'no'} episode{'s' * (episodes != 1)} ended"


def _trainings(folder: Path) -> list[Path]:
    """The folders of trainings in a folder, by name."""
    return sorted(path.parent for path in folder.glob(f"*/{RUN}"))
