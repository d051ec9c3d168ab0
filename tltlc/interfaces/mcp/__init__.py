"""The server for coding agents, ``tltlc mcp``: the commands of tltlc as tools of the Model Context Protocol.

Begin to read in `server`. Each module of `tools` has one tool; `tools.regress` starts a command of the
runtime, and all other tools run in the processes of `worker`.
"""
