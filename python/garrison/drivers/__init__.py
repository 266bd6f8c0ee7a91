"""Drivers: simulate a plant, replay a recording."""

from garrison.drivers.common import KEEP, require_room
from garrison.drivers.repeating import again
from garrison.drivers.replaying import replay
from garrison.drivers.simulating import simulate

__all__ = ["KEEP", "again", "replay", "require_room", "simulate"]
