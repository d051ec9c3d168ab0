"""The command line. Only code here, and in the commands of plugins, prints."""
