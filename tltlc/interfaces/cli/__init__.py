"""The command line. Only this package, and the commands of plugins, print."""
