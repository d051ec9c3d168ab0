"""The language server, ``tltlc lsp``: shows what the compiler knows about a text as you type.

Begin to read in `server`; `answers` has the functions for the editor's requests. Functions that return
ranges or positions count columns in units of an ``encoding``, which the editor chooses (`positions`).
"""
