"""The command line. Only this package, and the commands of other distributions, print.

Begin with `command_line`; the commands are in `commands`.
"""
