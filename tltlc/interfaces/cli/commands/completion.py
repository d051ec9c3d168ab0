"""``tltlc completion``: print the script that teaches a shell to complete commands and options."""

from __future__ import annotations

import click


@click.command(
    epilog="""\b
Put the line for your shell into its start-up file:
  bash   eval "$(tltlc completion bash)"
  zsh    eval "$(tltlc completion zsh)"
  fish   tltlc completion fish | source
"""
)
@click.argument("shell", type=click.Choice(("bash", "zsh", "fish")))
def command(shell: str) -> int:
    """Print the completion script of a shell."""
    from click.shell_completion import get_completion_class

    from tltlc.interfaces.cli.command_line import COMPLETE_VARIABLE, cli

    complete = get_completion_class(shell)
    assert complete is not None, "click knows these three"
    click.echo(complete(cli, {}, "tltlc", COMPLETE_VARIABLE).source())
    return 0
