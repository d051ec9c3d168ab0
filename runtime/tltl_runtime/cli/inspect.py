"""``tltlc inspect``: show what policies were trained for, and export them to ONNX."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tltl_runtime.cli.support.input_files import read_each
from tltl_runtime.cli.support.missing_extra import name_missing_extra
from tltl_runtime.cli.support.options import output_file, summary_format
from tltlc.api import cli

if TYPE_CHECKING:
    from tltl_runtime.policies.policy import Policy


@click.command(
    epilog="""\b
Examples:
  tltlc inspect lake_agent
  tltlc inspect bots/*.safetensors --format json
  tltlc inspect bot.safetensors -o bot.onnx      the policy for another engine
  tltlc inspect bot.safetensors -o bot.onnx --for ml-agents
"""
)
@click.argument("files", metavar="POLICY...", nargs=-1, required=True)
@output_file("OUT.onnx", "Write the policy as an ONNX model instead of the summary.")
@click.option(
    "--for",
    "player",
    type=click.Choice(("godot-rl", "ml-agents")),
    help="Give the inputs and outputs of the ONNX model the names that Godot RL Agents or ML-Agents expects.",
)
@summary_format
def command(files: tuple[str, ...], path: Path | None, player: str | None, format: str) -> int:  # noqa: A002
    """Show what policies were trained for, what they observe and choose, and how their training went.

    A POLICY is a .safetensors file, the folder of a training, or the name of a level for the policy that comes with it.
    """
    if path is not None and path.suffix.lower() != ".onnx":
        raise click.UsageError(f"-o writes a .onnx file, not `{path}`")
    if path is not None and len(files) > 1:
        raise click.UsageError("-o takes one POLICY")
    if player is not None and path is None:
        raise click.UsageError("--for is for the model that -o writes")
    summaries: list[dict[str, Any]] = []
    with cli.Report(format, results=True) as report, name_missing_extra("`tltlc inspect`"):
        from tltl_runtime.policies.summary import summary, summary_text

        for name, (policy, training_so_far, progress_line) in read_each(files, _read, report):
            fields = {"file": name, **summary(policy), **training_so_far}
            if path is not None:
                _export(policy, path, player)
                report.say(f"wrote {path}")
            elif format == "text":
                print(f"{name}\n{summary_text(fields)}{progress_line}")
            summaries.append(fields)
        if format == "json" and path is None:
            print(json.dumps(summaries, indent=2, ensure_ascii=False))
    return report.status


def _read(name: str) -> tuple[Policy, dict[str, Any], str]:
    """Return a policy, and the progress of its training as JSON data and as a line of text.

    The data and the text are empty unless ``name`` is the folder of a training that has not ended.
    """
    from tltl_runtime.cli.support.policy_path import policy_file, progress
    from tltl_runtime.policies.file import read_policy
    from tltl_runtime.training.files.run_file import RUN

    path = Path(name)
    policy = read_policy(policy_file(path))
    if policy.card.training or not (path / RUN).exists():
        return policy, {}, ""
    # Import this only here: reading a checkpoint needs torch; reading a policy does not.
    from tltl_runtime.training.files.record import record_so_far

    return policy, {"training": record_so_far(path)}, f"  ended    not yet: {progress(path)}\n"


def _export(policy: Policy, path: Path, player: str | None) -> None:
    from tltl_runtime.policies.onnx import to_onnx
    from tltl_runtime.policies.onnx_players import to_player_onnx
    from tltlc.api import fileio

    fileio.write_file(path, to_onnx(policy) if player is None else to_player_onnx(policy, player))
