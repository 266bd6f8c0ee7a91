"""What the site takes from the code: parameters, keys of scenarios, commands, benchmarks."""
