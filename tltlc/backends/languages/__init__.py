"""Parts of single targets whose modules would be too long: the reserved names of C, the syntax of Lua."""
