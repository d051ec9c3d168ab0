"""The policy that a command is to take: a file, or that of the training in a folder."""

from __future__ import annotations

from pathlib import Path
from shlex import quote

from tltl_runtime.training.metrics import METRICS, read_metrics
from tltl_runtime.training.run import POLICY, RUN, named_trainings
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


def policy_path(path: Path) -> Path:
    """The file of a policy: ``path``, or the one in this folder, which is there.

    Raises:
        TltlError: TLT0840, it is an ONNX model; TLT0872, there is no policy in the folder; TLT0001, what a training
            there measured cannot be read.
    """
    if path.suffix.lower() == ".onnx" and path.is_file():
        title = f"`{path}` is the model for other engines, which `tltlc inspect -o` wrote"
        raise TltlError([Diagnostic("TLT0840", title, help="name the .safetensors file that it was made of")])
    if not path.is_dir():
        return path
    if (path / POLICY).exists():
        return path / POLICY
    if (path / RUN).exists():
        title = f"the training in `{path}` has no policy yet: {progress(path)}"
        help_ = f"`tltlc train --resume {quote(str(path))}` goes on until it has one; one that is going on has it soon"
    elif named := named_trainings(path):
        title, help_ = f"`{path}` holds trainings, and is none itself", named
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
