"""The user interfaces: the command line, the language server and the playground."""
