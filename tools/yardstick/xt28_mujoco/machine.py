"""The machine file's numbers, and the pendulum arm's linkage (SI units, radians)."""

import math
import tomllib
from pathlib import Path
from types import SimpleNamespace

WHEELS = ("FR", "FL", "MR", "ML", "BR", "BL")
GRAVITY_M_S2 = 9.81
# The stroke at which the machine file gives the frames' positions, m.
REFERENCE_STROKE_M = 0.25


class Machine:
    """The sections of the file as attributes: `machine.wheels.radius_m`."""

    def __init__(self, path: Path):
        for section, numbers in tomllib.loads(path.read_text(encoding="utf-8")).items():
            setattr(self, section, SimpleNamespace(**numbers))
        self.linkage = Linkage(self.arms)

    def mass_kg(self) -> float:
        """Mass of the empty machine, kg."""
        m = self.masses
        frames = m.front_frame_kg + m.middle_frame_kg + m.rear_frame_kg
        return frames + len(WHEELS) * (m.arm_kg + m.wheel_kg)

    def arm_points_forward(self, wheel: str) -> bool:
        """Whether the wheel is ahead of its arm's pivot."""
        return (wheel[0] == "F") == (self.arms.front_arms_point == "forward")

    def circuits(self) -> list[list[int]]:
        """Indices of the three wheels of each hydrostatic circuit."""
        named = (self.wheels.circuit_1, self.wheels.circuit_2)
        return [[WHEELS.index(wheel) for wheel in circuit] for circuit in named]


class Linkage:
    """The triangle of cylinder, frame and arm. Angles are of the wheel line, from upward."""

    def __init__(self, arms: SimpleNamespace):
        self._eye_m = arms.pivot_to_cylinder_eye_m
        self._rod_m = arms.pivot_to_rod_eye_m
        self._wheel_m = arms.pivot_to_wheel_m
        self._closed_m = arms.closed_length_m
        self._offset_rad = arms.angle_frame_rad + arms.angle_arm_rad

    def angle_rad(self, stroke_m: float) -> float:
        """Arm angle at a stroke, by the law of cosines."""
        length_m = self._closed_m + stroke_m
        sides = self._eye_m**2 + self._rod_m**2 - length_m**2
        return self._offset_rad + math.acos(sides / (2.0 * self._eye_m * self._rod_m))

    def stroke_m(self, angle_rad: float) -> float:
        """Stroke at an arm angle."""
        return self._length_m(angle_rad) - self._closed_m

    def lever_m(self, angle_rad: float) -> float:
        """Lever of the cylinder force about the pivot: d(length)/d(angle), m/rad."""
        sine = math.sin(angle_rad - self._offset_rad)
        return self._eye_m * self._rod_m * sine / self._length_m(angle_rad)

    def drop_m(self, angle_rad: float) -> float:
        """Wheel centre below the pivot."""
        return -self._wheel_m * math.cos(angle_rad)

    def reach_m(self, angle_rad: float) -> float:
        """Wheel centre from the pivot, horizontally."""
        return self._wheel_m * math.sin(angle_rad)

    def _length_m(self, angle_rad: float) -> float:
        cosine = math.cos(angle_rad - self._offset_rad)
        return math.sqrt(
            self._eye_m**2 + self._rod_m**2 - 2.0 * self._eye_m * self._rod_m * cosine
        )
