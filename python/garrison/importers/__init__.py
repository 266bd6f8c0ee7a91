"""Recordings and cases of others as scenarios: cars, aircraft, grids, robots, tables."""
