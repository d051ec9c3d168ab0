-- The server that `vim.lsp.enable("tltlc")` starts, in Neovim 0.11 and later.
return { cmd = { "tltlc", "lsp" }, filetypes = { "tltl" }, root_markers = { "tltl.toml", ".git" } }
