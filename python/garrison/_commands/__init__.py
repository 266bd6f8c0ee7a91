"""One module a command: `add(commands)` declares it, `do(args)` runs it and returns the exit code."""
