"""The ground both engines stand on: level, or the ASCII grid that our side wrote; a ramp as a block.

On a grid MuJoCo gives a wheel a contact with each triangle that it cuts, four to seven of them on
level ground. A ramp's terrain file can be built as one convex block instead, which has none but the
contacts that are there.
"""

import tomllib
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


@dataclass(frozen=True)
class Block:
    """A convex block on level ground, by its corners."""

    corners_m: tuple[tuple[float, float, float], ...]


def read_ramp(path: Path) -> Block:
    """Reads a terrain file of one ramp; the block goes on half a metre below the ground."""
    ramp = tomllib.loads(path.read_text(encoding="utf-8"))
    if ramp.get("kind") != "ramp":
        raise ValueError(f"{path}: not a terrain of one ramp")
    foot, crest, end, out = ramp["x_m"]
    top, below = ramp["height_m"], -0.5
    outline = ((foot, 0.0), (crest, top), (end, top), (out, 0.0), (foot, below), (out, below))
    sides = (ramp["y_min_m"], ramp["y_max_m"])
    return Block(corners_m=tuple((x, y, z) for y in sides for x, z in outline))
