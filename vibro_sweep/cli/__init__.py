"""The command line: commands, what those that compute have in common, messages, exit status, Ctrl-C."""
