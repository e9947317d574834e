"""Reads a manoeuvre from the file that both sides share; see its comments for the form."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .machine import WHEELS


@dataclass(frozen=True)
class Actuation:
    """Actuator inputs over one step; see the plant's `Actuation` for ranges."""

    arm_opening: list[float]
    steer_opening: list[float]
    pump: float
    motor: float
    engine_rpm: float


class Manoeuvre:
    """Actuator inputs over time, and where and how long."""

    def __init__(self, path: Path, name: str):
        file = tomllib.loads(path.read_text(encoding="utf-8"))
        own = file[name]
        self.start_stroke_m = file["start_stroke_m"]
        self.duration_s = file["duration_s"]
        self.sample_s = file["sample_s"]
        self.settle_s = own["settle_s"]
        self._engine_rpm = file["engine_speed_rpm"]
        self._motor = file["motor_displacement"]
        still = [[0.0, 0.0]]
        self._arms = own.get("arm_opening", [still] * len(WHEELS))
        self._steer = own.get("steer_opening", [still] * 2)
        self._pump = own.get("pump_displacement", still)

    def at(self, time_s: float) -> Actuation:
        """Inputs at a time; before zero everything is closed."""

        def along(knots):
            return float(np.interp(time_s, *zip(*knots, strict=True))) if time_s >= 0.0 else 0.0

        return Actuation(
            arm_opening=[along(knots) for knots in self._arms],
            steer_opening=[along(knots) for knots in self._steer],
            pump=along(self._pump),
            motor=self._motor,
            engine_rpm=self._engine_rpm,
        )
