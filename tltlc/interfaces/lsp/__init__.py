"""The language server, ``tltlc lsp``: shows what the compiler knows about a text as you type.

Begin with `server`, and with `answers` for what the editor asks. Functions that return ranges or
positions count columns in an ``encoding``, which the editor chooses (`positions`).
"""
