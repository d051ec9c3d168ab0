"""Find the policy that a command names: a file, the folder of a training, or the policy that comes with a level."""

from __future__ import annotations

from pathlib import Path
from shlex import quote

from tltl_runtime.cli.support.level_argument import check_level_exists, check_no_scene, check_spelling, names_level
from tltl_runtime.game.level_name import GAME_FILE, split_level
from tltl_runtime.game.registry import game_of, shipped_levels
from tltl_runtime.gymnasium_games.level_scenes import level_of_scene
from tltl_runtime.policies.card import Card
from tltl_runtime.policies.shipped import shipped_policy
from tltl_runtime.training.files.metrics import METRICS, read_metrics
from tltl_runtime.training.files.run_file import POLICY, RUN, named_trainings, read_level_and_variant, resume_command
from tltlc.api import Diagnostic, TltlError, fileio


def policy_place(policy: Path | None, level: str | None, command: str) -> tuple[Path, str | None, str | None]:
    """Return the file of a policy, and the level and the variant to play.

    ``policy`` is a path, or ``LEVEL`` or ``LEVEL:VARIANT`` for the policy that comes with a level.
    Without ``policy``, the policy that comes with ``level`` is used. At least one of the two must
    be given. ``command`` is a command that takes a policy as its argument; messages suggest it.

    The returned variant is None if none was named. If the returned level is None, the caller plays the
    level and the variant that the card, the description inside the policy's file, names.

    Raises:
        TltlError: TLT0853, no policy comes with the level; TLT0800, the level does not exist; TLT0001,
            the file of the policy's level is missing; and the errors of :func:`policy_path`.
    """
    name, variant = (None, None) if level is None else split_level(level)
    if policy is not None and names_level(level_of_scene(str(policy))):
        policy_level, policy_variant = split_level(level_of_scene(str(policy)))
        return policy_file(policy), name or policy_level, variant if name else policy_variant
    if policy is None:
        assert name is not None
        return _shipped_policy_file(name), name, variant
    path = policy_path(policy)
    if name is None and fileio.is_file(policy / RUN):
        # The card has only the level's name; the folder of the training has the path of its file.
        name, variant = read_level_and_variant(policy)
        check_level_exists(name, variant, f"{command} {quote(str(policy))}")
    return path, name, variant


def policy_file(policy: Path) -> Path:
    """Return the file of a policy. ``policy`` has the same forms as in :func:`policy_place`; no level is checked.

    Raises:
        TltlError: TLT0853, no policy comes with the level; and the errors of :func:`policy_path`.
    """
    level = level_of_scene(str(policy))
    return _shipped_policy_file(split_level(level)[0]) if names_level(level) else policy_path(policy)


def check_level_is_shipped(card: Card, policy: Path, command: str) -> None:
    """Raise TltlError, TLT0800, if a policy was trained on a user's level, or in a user's game.

    The policy's file does not contain the path of that level or game, so the user must name it.
    ``command`` is the command that the help of the error suggests.
    """
    level = card.level
    if card.spaces is not None:
        title = f"the policy was trained in the scene `{level}` of a game of your own, and does not say where it is"
        help_ = f"name its game file: `{command} {quote(str(policy))} --game FILE{GAME_FILE}:{level}`"
        raise TltlError([Diagnostic("TLT0800", title, help=help_)])
    if level not in shipped_levels():
        title = f"there is no level `{level}`: the policy was trained on a level of your own"
        help_ = f"name its file: `{command} {quote(str(policy))} --level {level}.toml`"
        raise TltlError([Diagnostic("TLT0800", title, help=help_)])


def policy_path(path: Path) -> Path:
    """Return the file of a policy: ``path`` itself, or the policy in it if it is a folder.

    Raises:
        TltlError: TLT0840, the file is an ONNX model or a TOML file, or the path is a scene; TLT0872, the folder
            contains no policy; TLT0001, the metrics of the training cannot be read, or the path does not exist and
            resembles a level's name.
    """
    check_spelling(str(path))
    check_no_scene(path)
    if path.suffix.lower() == ".onnx" and fileio.is_file(path):
        title = f"`{path}` is an ONNX model for other engines, not a policy"
        raise TltlError(
            [Diagnostic("TLT0840", title, help="name the .safetensors file from which `tltlc inspect -o` made it")]
        )
    if path.suffix.lower() == ".toml" and fileio.is_file(path):
        title = f"`{path}` is a TOML file, e.g. a level, not a policy"
        help_ = "name a .safetensors file, or the folder of a training; name a level with --level"
        raise TltlError([Diagnostic("TLT0840", title, help=help_)])
    if not fileio.is_dir(path):
        return path
    if fileio.exists(path / POLICY):
        return path / POLICY
    if fileio.exists(path / RUN):
        title = f"the training in `{path}` has no policy yet: {progress(path)}"
        help_ = f"`{resume_command(path)}` continues it until it has one; if it is running, it will have one soon"
    elif suggestion := named_trainings(path):
        title, help_ = f"`{path}` contains trainings, but is not a training itself", suggestion
    else:
        title = f"there is neither a training nor a policy in `{path}`"
        help_ = "name a .safetensors file, or the folder that `tltlc train` named when it ended"
    raise TltlError([Diagnostic("TLT0872", title, help=help_)])


def progress(folder: Path) -> str:
    """Describe the progress of the training in a folder.

    Raises TltlError, TLT0001, if its metrics cannot be read.
    """
    metrics = read_metrics(folder / METRICS)
    if not metrics:
        return "its first iteration is not finished"
    episodes = sum(iteration["episodes"] for iteration in metrics)
    return f"after {metrics[-1]['steps']:,} steps, {episodes or 'no'} episode{'s' * (episodes != 1)} ended"


def _shipped_policy_file(level: str) -> Path:
    """Return the policy that comes with a level; raises TltlError, TLT0853, if there is none."""
    path = shipped_policy(level)
    if path is None:
        game_of(level).load_level(level)
        help_ = f"name a policy that you trained, e.g. with `tltlc train --level {level}`"
        raise TltlError([Diagnostic("TLT0853", f"no policy comes with the level `{level}`", help=help_)])
    return path
