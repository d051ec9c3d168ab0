"""Parts that would make the module of a target too long: the reserved names of C, and the syntax of Lua."""
