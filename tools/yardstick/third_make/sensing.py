"""Pins of the ECUs and fixes of the receiver: what is there, as sensors read it."""

import math
from collections import deque

import numpy as np

from xt28_mujoco.machine import GRAVITY_M_S2, Machine

from .ecu import TICK_S
from .truth import N, Truth

# Standard deviations where the machine file has none (assumed).
STROKE_MM = 0.2
PRESSURE_KPA = 6.0
WHEEL_RPM = 0.03
JOINT_DEG = 0.008
GYRO_DEG_S = 0.05
ACCELERATION_M_S2 = 0.03
FULL_RANGE_KPA = 25000


class Sensors:
    """Draws the noise; keeps what is late."""

    def __init__(self, machine: Machine, truth: Truth, random: np.random.Generator):
        self._truth, self._random, self._machine = truth.sensors, random, machine
        self._places: deque = deque()
        self._wander = np.zeros(2)
        self._stroke_mm: np.ndarray | None = None
        self._slow: dict[str, np.ndarray] = {}
        a = machine.arms
        self._areas = (a.area_bore_m2, a.area_rod_m2)

    def _noise(self, deviation: float, count: int) -> np.ndarray:
        return deviation * self._truth.noise * self._random.standard_normal(count)

    def _lagged(self, reading: str, there, lag_s: float) -> np.ndarray:
        """What a reading of every tick is behind a first-order lag."""
        keep = math.exp(-TICK_S / lag_s) if lag_s > 0.0 else 0.0
        before = self._slow.get(reading, there)
        self._slow[reading] = keep * np.asarray(before) + (1.0 - keep) * np.asarray(there)
        return self._slow[reading]

    def strokes_mm(self, stroke_m) -> list[int]:
        """Cut to whole millimetres."""
        s = self._truth
        there = np.asarray(stroke_m) * 1e3
        half = 0.5 * s.stroke_play_mm
        before = there if self._stroke_mm is None else self._stroke_mm
        self._stroke_mm = np.clip(before, there - half, there + half)
        read = self._stroke_mm * s.stroke_scale + s.stroke_bias_mm
        return [max(0, int(mm)) for mm in read + self._noise(STROKE_MM, N)]

    def pressures_kpa(self, oil_n) -> list[float]:
        """Chambers A and B of every arm, cut to what the sensor spans."""
        s, idle = self._truth, self._machine.hydraulics.return_pressure_pa
        bore, rod = self._areas
        noise = self._noise(PRESSURE_KPA, 2 * N)
        chambers = []
        for i, push in enumerate(oil_n):
            # The side that carries nothing idles at the return's pressure, the other balances.
            if push >= 0.0:
                a_pa, b_pa = (push + idle * rod) / bore, idle
            else:
                a_pa = idle * rod / bore
                b_pa = (a_pa * bore - push) / rod
            chambers += [a_pa, b_pa]
        read = []
        for k, pa in enumerate(self._lagged("pressure", chambers, s.pressure_lag_s)):
            bias = s.pressure_bias_kpa[k // 2] if k % 2 == 0 else 0.0
            kpa = float(pa) * 1e-3 * s.pressure_scale[k // 2] + bias + noise[k]
            read.append(min(max(kpa, 0.0), FULL_RANGE_KPA))
        return read

    def inertial(self, force_m_s2, rate_rad_s) -> tuple[float, float, float, float]:
        """Roll and pitch rate, deg/s, and the tilt that the specific force shows, deg."""
        s = self._truth
        fx, fy, fz = np.asarray(force_m_s2) + self._noise(ACCELERATION_M_S2, 3)
        gyro = self._noise(GYRO_DEG_S, 2)
        roll = math.degrees(math.atan2(-fy, fz)) + s.imu_roll_deg
        pitch = math.degrees(math.atan2(fx, fz)) + s.imu_pitch_deg
        # About x forward a positive turn lifts the left side, about y left it drops the nose.
        roll_rate = -math.degrees(rate_rad_s[0]) + gyro[0]
        pitch_rate = -math.degrees(rate_rad_s[1]) + gyro[1]
        return roll_rate, pitch_rate, roll, pitch

    def wheels_rpm(self, rate_rad_s) -> np.ndarray:
        """Signed speeds of the wheels beside their arms."""
        s = self._truth
        slow = self._lagged("wheel", np.asarray(rate_rad_s), s.wheel_lag_s)
        return slow * 60.0 / math.tau * s.wheel_scale + self._noise(WHEEL_RPM, N)

    def joints_deg(self, angle_rad) -> list[float]:
        """Both joints, in hundredths."""
        bias, scale = self._truth.joint_bias_deg, self._truth.joint_scale
        there = [bias + scale * math.degrees(a) for a in angle_rad]
        slow = self._lagged("joint", there, self._truth.joint_lag_s)
        return [round(x, 2) for x in slow + self._noise(JOINT_DEG, 2)]

    def antenna_m(self) -> np.ndarray:
        """Where the antenna is on the front frame."""
        x, y, z = self._machine.sensors.gnss_antenna_m
        return np.array((x + self._truth.antenna_ahead_m, y + self._truth.antenna_left_m, z))

    def watch(self, time_s: float, place) -> None:
        """Keeps where the antenna is; called every tick."""
        self._places.append((time_s, place))
        while self._places[0][0] < time_s - 2.0:
            self._places.popleft()

    def fix(self, time_s: float) -> tuple[np.ndarray, np.ndarray, float]:
        """Position, m; velocity, m/s; heading, rad: of a while ago if the receiver is late."""
        s, m = self._truth, self._machine.sensors
        then = time_s - s.gnss_late_s + 1e-9
        position, velocity, heading = next(
            (p for t, p in reversed(self._places) if t <= then), self._places[0][1]
        )
        self._wander = 0.985 * self._wander + self._random.standard_normal(2) * s.wander_m * 0.17
        spread = np.array((m.gnss_velocity_xy_m_s,) * 2 + (m.gnss_velocity_z_m_s,))
        position = position + self._noise(m.gnss_position_m, 3)
        position[:2] += self._wander
        velocity = velocity + spread * self._noise(1.0, 3)
        heading += math.radians(s.heading_bias_deg) + self._noise(m.gnss_heading_rad, 1)[0]
        return position, velocity, heading


def specific_force(acceleration_m_s2, turn, gravity_m_s2) -> np.ndarray:
    """What an accelerometer on the frame feels, in the frame's axes."""
    return turn.T @ (np.asarray(acceleration_m_s2) - np.asarray(gravity_m_s2))


def level_gravity(along: float, across: float) -> tuple[float, float, float]:
    """Gravity on a slope that climbs along x and, to the left, along y."""
    size = math.sqrt(1.0 + along**2 + across**2)
    return tuple(-GRAVITY_M_S2 * part / size for part in (along, across, 1.0))
