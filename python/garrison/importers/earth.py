"""Positions and velocities on the WGS 84 ellipsoid in a plane of metres, such that velocities are derivatives.

x = N(lat0) cos(lat0) (lon - lon0), y = the meridian arc from lat0: equidistant along meridians and along one parallel.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_A, _F = 6378137.0, 1.0 / 298.257223563
_E2 = _F * (2.0 - _F)


@dataclass(frozen=True)
class Plane:
    """A plane around an origin; latitude, longitude: degrees."""

    latitude: float
    longitude: float

    def position(self, latitude: Array, longitude: Array) -> Array:
        """Metres east and north (rows, 2)."""
        away = np.deg2rad((longitude - self.longitude + 180.0) % 360.0 - 180.0)
        return np.column_stack([self._parallel() * away, _meridian(latitude) - _meridian(np.array(self.latitude))])

    def velocity(self, latitude: Array, altitude: Array, speed: Array, track: Array) -> Array:
        """Velocity in the plane (rows, 2), m/s, of a speed over ground on a track (degrees from north, clockwise)."""
        lat, angle = np.deg2rad(latitude), np.deg2rad(track)
        across, along = _radii(lat)
        east = speed * np.sin(angle) * self._parallel() / ((across + altitude) * np.cos(lat))
        return np.column_stack([east, speed * np.cos(angle) * along / (along + altitude)])

    def _parallel(self) -> float:
        lat = np.deg2rad(self.latitude)
        return float(_radii(np.array(lat))[0] * np.cos(lat))


def _radii(latitude: Array) -> tuple[Array, Array]:
    """Radii of curvature across and along the meridian."""
    w = 1.0 - _E2 * np.sin(latitude) ** 2
    return _A / np.sqrt(w), _A * (1.0 - _E2) / w**1.5


def _meridian(latitude: Array) -> Array:
    """Length of the meridian from the equator: the series in the third flattening, good to micrometres."""
    lat, n = np.deg2rad(latitude), _F / (2.0 - _F)
    scale = _A / (1.0 + n) * (1.0 + n**2 / 4.0 + n**4 / 64.0)
    terms = (-1.5 * n + 9.0 / 16.0 * n**3, 15.0 / 16.0 * n**2 - 15.0 / 32.0 * n**4, -35.0 / 48.0 * n**3)
    return np.asarray(scale * (lat + sum(c * np.sin(2 * (k + 1) * lat) for k, c in enumerate(terms))))
