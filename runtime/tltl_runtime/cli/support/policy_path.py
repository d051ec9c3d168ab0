"""The policy that a command is to take: a file, that of the training in a folder, or that which comes with a level."""

from __future__ import annotations

from pathlib import Path
from shlex import quote

from tltl_runtime.cli.support.level_argument import check_spelling, check_there, names_level
from tltl_runtime.policies.shipped import shipped_policy
from tltl_runtime.stealth.levels.file import level_names, load_level
from tltl_runtime.stealth.levels.place import level_place
from tltl_runtime.training.run.metrics import METRICS, read_metrics
from tltl_runtime.training.run.run import POLICY, RUN, named_trainings, read_place, resume_command
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import exists, is_dir, is_file


def policy_place(policy: Path | None, level: str | None, command: str) -> tuple[Path, str | None, str | None]:
    """The file of a policy, and the level and the variant that it is taken for; None: as its card says.

    ``policy`` is a path, or ``LEVEL`` or ``LEVEL:VARIANT`` for the policy that comes with it, as that of ``level`` is
    where there is none.  One of the two is given.  ``command`` takes a policy as its argument, for messages.

    Raises:
        TltlError: TLT0853, no policy comes with the level; TLT0800, there is no such level; TLT0001, the file of its
            level is gone; and as :func:`policy_path`.
    """
    name, variant = (None, None) if level is None else level_place(level)
    if policy is not None and names_level(str(policy)):
        named, its = level_place(str(policy))
        return policy_file(policy), name or named, variant if name else its
    if policy is None:
        assert name is not None
        return _shipped(name), name, variant
    path = policy_path(policy)
    if name is None and is_file(policy / RUN):
        # The card has the level's name alone, and here is the path of its file.
        name, variant = read_place(policy)
        check_there(name, variant, f"{command} {quote(str(policy))}")
    return path, name, variant


def policy_file(policy: Path) -> Path:
    """The file of a policy as :func:`policy_place` takes one, wherever its level is; errors as there, of the policy."""
    return _shipped(level_place(str(policy))[0]) if names_level(str(policy)) else policy_path(policy)


def check_known(level: str, policy: Path, command: str) -> None:
    """TLT0800 where a policy, of whose training there is its file alone, was trained on a level of one's own."""
    if level not in level_names():
        title = f"there is no level `{level}`: the policy was trained on a level of your own"
        help_ = f"name its file: `{command} {quote(str(policy))} --level {level}.toml`"
        raise TltlError([Diagnostic("TLT0800", title, help=help_)])


def policy_path(path: Path) -> Path:
    """The file of a policy: ``path``, or the one in this folder, which is there.

    Raises:
        TltlError: TLT0840, it is an ONNX model or a level; TLT0872, there is no policy in the folder; TLT0001, what a
            training there measured cannot be read, or it is not there, and a level's name is like it.
    """
    check_spelling(str(path))
    if path.suffix.lower() == ".onnx" and is_file(path):
        title = f"`{path}` is the model for other engines, which `tltlc inspect -o` wrote"
        raise TltlError([Diagnostic("TLT0840", title, help="name the .safetensors file that it was made of")])
    if path.suffix.lower() == ".toml" and is_file(path):
        title = f"`{path}` is a TOML file, e.g. a level, and no policy"
        help_ = "a policy is a .safetensors file, or the folder of a training; a level is named with --level"
        raise TltlError([Diagnostic("TLT0840", title, help=help_)])
    if not is_dir(path):
        return path
    if exists(path / POLICY):
        return path / POLICY
    if exists(path / RUN):
        title = f"the training in `{path}` has no policy yet: {progress(path)}"
        help_ = f"`{resume_command(path)}` goes on until it has one; one that is going on has it soon"
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


def _shipped(level: str) -> Path:
    """The policy that comes with a level."""
    found = shipped_policy(level)
    if found is None:
        load_level(level)
        help_ = f"name one that was trained, e.g. after `tltlc train --level {level}`"
        raise TltlError([Diagnostic("TLT0853", f"no policy comes with the level `{level}`", help=help_)])
    return found
