"""One module per command, loaded when its command is named.

Each module defines one click command, ``command``.
"""
