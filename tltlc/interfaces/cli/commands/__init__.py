"""One module per command, loaded when its command is named; each holds one click command, ``command``."""
