"""A network of real daemons on one machine: `garrison-net`."""

from garrison.net.client import Client

__all__ = ["Client"]
