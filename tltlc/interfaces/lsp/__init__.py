"""The language server: what the compiler knows of a text, while it is being written; ``tltlc lsp``."""
