"""What people and editors use: the command line, the language server and the playground."""
