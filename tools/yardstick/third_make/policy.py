"""Drives as a learnt controller makes them: to goals, level, and never quite still."""

import math
from dataclasses import dataclass

import numpy as np

from .truth import N

PERIOD_S = 0.1
ARRIVED_M = 1.5
MOST_STEER_DEG = 18.0
STROKES_MM = (70.0, 330.0)
MOST_MM_S = 60.0
# Sides and axles of the arms, in the order of WHEELS: right > 0, front > 0.
SIDE = np.array((1.0, -1.0) * 3)
AXLE = np.array((1.0, 1.0, 0.0, 0.0, -1.0, -1.0))


@dataclass(frozen=True)
class Seen:
    """What the bus tells a controller: place, m; heading, rad; roll (right high) and pitch (nose up), deg."""

    place_m: tuple[float, float]
    heading_rad: float
    roll_deg: float
    pitch_deg: float


class Jitter:
    """Numbers that wander about nothing, with a memory of a second or so."""

    def __init__(self, size: float, memory_s: float, count: int, random: np.random.Generator):
        self._random, self._count = random, count
        self._keep = math.exp(-PERIOD_S / memory_s)
        self._draw = size * math.sqrt(1.0 - self._keep**2)
        self._now = np.zeros(count)

    def next(self) -> np.ndarray:
        """A tenth of a second on."""
        self._now = self._keep * self._now + self._draw * self._random.standard_normal(self._count)
        return self._now


@dataclass
class Policy:
    """Asked ten times a second; what it asked for holds until then."""

    name: str
    seconds: float
    fit: bool
    goals_m: list[tuple[float, float]]
    pace_percent: float
    base_mm: float
    random: np.random.Generator
    ramp: bool = False

    def __post_init__(self):
        self._next_s, self._asked = 0.0, None
        self._level_mm = np.zeros(2)
        self._strokes = Jitter(12.0, 1.5, N, self.random)
        self._drive = Jitter(1.0, 1.0, 2, self.random)
        self._target_mm = np.full(N, self.base_mm)
        self._goals = list(self.goals_m)

    def at(self, time_s: float, seen: Seen | None = None):
        """Targets, mm in steps of 2; throttle, %; front angle, deg."""
        if seen is None or time_s < 1.0:
            return self._steps(), 0.0, 0.0
        if time_s >= self._next_s - 1e-9:
            self._next_s = time_s + PERIOD_S
            self._move(seen)
            self._asked = (self._steps(), *self._go(seen))
        return self._asked

    def _steps(self) -> list[int]:
        return [2 * round(mm / 2.0) for mm in self._target_mm]

    def _move(self, seen: Seen) -> None:
        """Sums up what is not level; targets go no faster than a careful driver lets them."""
        tilt = np.array((seen.roll_deg, seen.pitch_deg))
        self._level_mm = np.clip(self._level_mm - 8.0 * PERIOD_S * tilt, -90.0, 90.0)
        wanted = self.base_mm + SIDE * self._level_mm[0] + AXLE * self._level_mm[1]
        wanted = np.clip(wanted + self._strokes.next(), *STROKES_MM)
        most = MOST_MM_S * PERIOD_S
        self._target_mm += np.clip(wanted - self._target_mm, -most, most)

    def _go(self, seen: Seen) -> tuple[float, float]:
        jitter = self._drive.next()
        if not self._goals:
            return 0.0, 0.0
        ahead, aside = (goal - at for goal, at in zip(self._goals[0], seen.place_m, strict=True))
        distance = math.hypot(ahead, aside)
        if distance < ARRIVED_M:
            self._goals.pop(0)
        off = math.atan2(aside, ahead) - seen.heading_rad
        off = math.degrees(math.atan2(math.sin(off), math.cos(off)))
        steer = min(max(0.7 * off + 1.5 * jitter[1], -MOST_STEER_DEG), MOST_STEER_DEG)
        throttle = self.pace_percent * min(1.0, 0.25 + 0.2 * distance) + 4.0 * jitter[0]
        return round(min(max(throttle, 0.0), 100.0), 1), round(steer, 1)


def drives(random: np.random.Generator) -> list[Policy]:
    """Six drives: four on the level, two over the ramp."""
    chosen = []
    for number, fit in enumerate((True, True, False, True, True, False)):
        ramp = number in (3, 5)
        goals, course = [(0.0, 0.0)], 0.0
        while len(goals) < 4 and not ramp:
            course += math.radians(random.uniform(-50.0, 50.0))
            far = random.uniform(7.0, 14.0)
            x, y = goals[-1]
            goals.append((x + far * math.cos(course), y + far * math.sin(course)))
        goals = goals[1:] or [(26.0, 0.0)]
        own = np.random.default_rng(random.integers(2**32))
        pace, base = random.uniform(45.0, 75.0), random.uniform(130.0, 220.0)
        name = "policy_ramp" if ramp else "policy"
        chosen.append(Policy(name, 40.0, fit, goals, pace, base, own, ramp))
    return chosen
