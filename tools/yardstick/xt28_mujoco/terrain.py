"""The ground both engines stand on: level, or the ASCII grid that our side wrote."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class Grid:
    """Heights at the nodes of a square grid; `height_m[row, column]`, row 0 at the least y."""

    x_m: float
    y_m: float
    spacing_m: float
    height_m: np.ndarray

    def centre_m(self) -> tuple[float, float]:
        """Middle of the grid."""
        rows, columns = self.height_m.shape
        half = self.spacing_m / 2.0
        return self.x_m + (columns - 1) * half, self.y_m + (rows - 1) * half

    def half_extent_m(self) -> tuple[float, float]:
        """Half the length along x and along y."""
        rows, columns = self.height_m.shape
        half = self.spacing_m / 2.0
        return (columns - 1) * half, (rows - 1) * half


def read(path: Path) -> Grid:
    """Reads an ESRI ASCII grid with node (not cell corner) coordinates; its first row is north."""
    with path.open(encoding="ascii") as lines:
        header = dict(next(lines).lower().split() for _ in range(5))
        rows = np.loadtxt(lines, dtype=np.float32, ndmin=2)
    expected = (int(header["nrows"]), int(header["ncols"]))
    if rows.shape != expected:
        raise ValueError(f"{path}: {rows.shape} heights where the header says {expected}")
    return Grid(
        x_m=float(header["xllcenter"]),
        y_m=float(header["yllcenter"]),
        spacing_m=float(header["cellsize"]),
        height_m=rows[::-1].copy(),
    )
