"""One module per command, loaded when its command is named.

Each defines one click command, ``command``.
"""
