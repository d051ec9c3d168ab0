"""The command line. Only this package, and commands from other installed packages, print.

Begin with `command_line`; the commands are in `commands`.
"""
