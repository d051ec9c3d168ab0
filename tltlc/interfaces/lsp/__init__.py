"""The language server, ``tltlc lsp``: shows what the compiler knows about a text as you type."""
