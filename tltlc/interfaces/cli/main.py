"""The entry point, which imports nothing by itself: Ctrl-C is to be handled before anything slow begins.

Python's own handler prints a traceback, and raises in the middle of whatever is being imported.
"""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import FrameType
    from typing import NoReturn


def main(arguments: "Sequence[str] | None" = None) -> "NoReturn":
    """Run the command line and exit with its status.

    Without ``arguments``, take those of the process, and handle its signals and its standard streams.
    """
    if arguments is None:
        _run_process()
    from tltlc.interfaces.cli.command_line import cli

    cli.main(args=list(arguments))


def end_at_once(number: int = 2, frame: "FrameType | None" = None) -> "NoReturn":
    """Handle Ctrl-C while the command line is being loaded: nothing has been done yet, so nothing needs to be kept."""
    import os

    os._exit(128 + number)


def _run_process() -> "NoReturn":
    try:
        import signal

        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, end_at_once)
        from tltlc.interfaces.cli.streams import open_missing_streams

        open_missing_streams()
        from tltlc.interfaces.cli.command_line import cli
        from tltlc.interfaces.cli.interrupts import signals_end

        with signals_end():
            cli.main()
    except KeyboardInterrupt:
        # It came before the first handler was there, or behind the last one.
        raise SystemExit(_interrupted()) from None


def _interrupted() -> int:
    """The exit status for the signal that came; before the command line was loaded, only Ctrl-C raises anything."""
    import sys

    exits = sys.modules.get("tltlc.interfaces.cli.exits")
    return exits.interrupted() if exits else 130
