"""Both controllers, a tick of 10 ms each: laws of the paper's ECUs as field tests describe them."""

import math

from xt28_mujoco.machine import Machine

from .truth import N, Truth

TICK_S = 0.01
FILTER = 0.94088
SHUT_MA = 400.0


def cut(value: float) -> int:
    """Toward zero, as an integer ECU does."""
    return int(value)


class ArmEcu:
    """Position control of the arms, filters of the pressures, attitude from the inertial unit."""

    def __init__(self, truth: Truth):
        self._truth = truth
        self._sum = [0.0] * N
        self._target_mm: list[float] | None = None
        self.pressure_kpa: list[int] | None = None
        self._roll_mdeg = self._pitch_mdeg = 0
        self.current_ma = [0] * N

    def tick(self, target_mm, stroke_mm, pressure_kpa, inertial) -> None:
        """Takes readings; `inertial` is roll and pitch rate, deg/s, then what gravity says, deg."""
        arms = self._truth.arms
        if self._target_mm is None:
            self._target_mm = list(target_mm)
        most_mm = arms.target_mm_s * TICK_S
        for i in range(N):
            self._target_mm[i] += min(max(target_mm[i] - self._target_mm[i], -most_mm), most_mm)
            error = self._target_mm[i] - stroke_mm[i]
            if abs(error) < arms.ecu_dead_mm:
                error = 0.0
            self._sum[i] = min(max(self._sum[i] + error * TICK_S, -100.0), 100.0)
            opening = 0.004 * arms.kp[i] * error + 1e-4 * arms.ki[i] * self._sum[i]
            opening = min(max(opening, -0.3), 0.3)
            size = round(SHUT_MA * abs(opening))
            self.current_ma[i] = int(math.copysign(size, opening)) if size else 0
        if self.pressure_kpa is None:
            self.pressure_kpa = [cut(p) for p in pressure_kpa]
        self.pressure_kpa = [
            cut(FILTER * y + (1.0 - FILTER) * p)
            for y, p in zip(self.pressure_kpa, pressure_kpa, strict=True)
        ]
        roll_rate, pitch_rate, roll_deg, pitch_deg = inertial
        a, b = self._truth.sensors.imu_keep_roll, self._truth.sensors.imu_keep_pitch
        self._roll_mdeg = cut(
            a * (self._roll_mdeg + roll_rate * 1e3 * TICK_S) + (1.0 - a) * roll_deg * 1e3
        )
        self._pitch_mdeg = cut(
            b * (self._pitch_mdeg + pitch_rate * 1e3 * TICK_S) + (1.0 - b) * pitch_deg * 1e3
        )

    def openings(self) -> list[float]:
        """What the currents ask of the valves; extending > 0."""
        return [ma / SHUT_MA for ma in self.current_ma]

    def attitude_deg(self) -> tuple[float, float]:
        """Roll, right side high > 0; pitch, nose up > 0."""
        return self._roll_mdeg / 1e3, self._pitch_mdeg / 1e3


class DriveEcu:
    """Steering by angle, the rear joint after the front one; the throttle goes straight on."""

    def __init__(self, machine: Machine, truth: Truth):
        self._truth = truth.steering
        self._a = machine.articulation
        self._radius_m = machine.wheels.radius_m
        self._sum = [0.0, 0.0]
        self.opening = [0.0, 0.0]

    def tick(self, target_deg: float, joint_deg, wheel_rpm) -> None:
        """Takes readings: both joints, six signed wheel speeds."""
        t, a = self._truth, self._a
        mean_m_s = abs(sum(wheel_rpm)) / N * math.tau / 60.0 * self._radius_m
        if mean_m_s < a.speed_threshold_m_s:
            self._sum, self.opening = [0.0, 0.0], [0.0, 0.0]
            return
        for j, target in enumerate((target_deg, t.rear_ratio * joint_deg[0] + t.rear_offset_deg)):
            error = target - joint_deg[j]
            self._sum[j] = min(max(self._sum[j] + error * TICK_S, -40.0), 40.0)
            opening = a.kp_per_deg * t.kp * (error + a.ki_per_s * t.ki * self._sum[j])
            self.opening[j] = min(max(opening, -1.0), 1.0)
