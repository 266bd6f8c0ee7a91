"""Scenario files: TOML in, objects out. Unknown keys are refused with the nearest known name."""

from garrison.scenario.reader import CENTRAL_KALMAN, Scenario, read_document, read_scenario

__all__ = ["CENTRAL_KALMAN", "Scenario", "read_document", "read_scenario"]
