"""Drivers: simulate a plant, replay a recording."""

from garrison.drivers.common import require_room
from garrison.drivers.keeping import KEEP, every, kept, reduce
from garrison.drivers.repeating import again
from garrison.drivers.replaying import replay
from garrison.drivers.simulating import simulate

__all__ = ["KEEP", "again", "every", "kept", "reduce", "replay", "require_room", "simulate"]
