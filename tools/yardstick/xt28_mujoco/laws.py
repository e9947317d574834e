"""What MuJoCo does not know: valves and soft locks, the hydrostatic drive, rolling resistance."""

import math

import numpy as np

from .machine import GRAVITY_M_S2, REFERENCE_STROKE_M, WHEELS, Machine

# End stops of a cylinder (assumed, as in our plant).
STOP_STIFFNESS_N_M = 2.0e7
STOP_DAMPING_N_S_M = 2.0e5
STOP_DAMPED_AT_M = 1.0e-3
# A full pump on full motors turns the wheels at a third of full speed (sequence of displacements).
FULL_DISPLACEMENT_SHARE = 1.0 / 3.0
# A wheel this much off its circuit's mean is pulled back (assumed, as in our plant).
SLIP_FREE_RAD_S = 4.0 * math.tau / 60.0
SLIP_GAIN_NMS = 6.0e3
# Below this wheel speed rolling resistance fades, rad/s (assumed, as in our plant).
DRAG_FADE_RAD_S = 0.05


def clamp(value: float, low: float, high: float) -> float:
    """The nearest value between two bounds."""
    return min(max(value, low), high)


def stop_push(depth_m: float, rate_m_s: float) -> tuple[float, float, float]:
    """Push of an end stop at a depth and a rate into it, N; its slopes. It never pulls."""
    damping = STOP_DAMPING_N_S_M * min(depth_m / STOP_DAMPED_AT_M, 1.0)
    push_n = STOP_STIFFNESS_N_M * depth_m + damping * rate_m_s
    if depth_m <= 0.0 or push_n <= 0.0:
        return 0.0, 0.0, 0.0
    deepening = STOP_DAMPING_N_S_M / STOP_DAMPED_AT_M if depth_m < STOP_DAMPED_AT_M else 0.0
    return push_n, STOP_STIFFNESS_N_M + deepening * rate_m_s, damping


class ArmLocks:
    """Six cylinders: the valve moves a rest position, the accumulator makes it a spring."""

    def __init__(self, machine: Machine, stroke_m: float):
        h, arms = machine.hydraulics, machine.arms
        self._linkage = machine.linkage
        self._reference_rad = self._linkage.angle_rad(REFERENCE_STROKE_M)
        self._speed_m_s = h.speed_full_m_s
        self._stiffness = h.lock_stiffness_n_m
        self._damping = h.lock_damping_n_s_m
        self._stroke_max_m = arms.stroke_max_m
        self._reach_m = arms.force_max_n / h.lock_stiffness_n_m
        # Each carries a sixth of the weight where it stands.
        angle = self._linkage.angle_rad(stroke_m)
        ratio = self._linkage.lever_m(angle) / self._linkage.reach_m(angle)
        load_n = machine.mass_kg() * GRAVITY_M_S2 / len(WHEELS) / ratio
        self.rest_m = [stroke_m + load_n / self._stiffness] * len(WHEELS)

    def stroke_m(self, hinge_rad: float) -> float:
        """Stroke at a hinge angle (zero at the reference stroke, extending > 0)."""
        return self._linkage.stroke_m(self._reference_rad + hinge_rad)

    def step(
        self, wheel: int, opening: float, hinge_rad: float, hinge_rad_s: float, dt_s: float
    ):
        """Moves the valve; returns the hinge's stiffness, damping and rest, linearised here."""
        angle = self._reference_rad + hinge_rad
        lever_m = self._linkage.lever_m(angle)
        stroke_m = self._linkage.stroke_m(angle)
        rest_m = self.rest_m[wheel] + clamp(opening, -1.0, 1.0) * self._speed_m_s * dt_s
        rest_m = clamp(rest_m, stroke_m - self._reach_m, stroke_m + self._reach_m)
        self.rest_m[wheel] = rest_m
        stiffness, damping = self._stiffness, self._damping
        force_n = stiffness * (rest_m - stroke_m)
        beyond_m = stroke_m - clamp(stroke_m, 0.0, self._stroke_max_m)
        side = math.copysign(1.0, beyond_m)
        out_n, deeper_n_m, faster_n_s_m = stop_push(abs(beyond_m), side * hinge_rad_s * lever_m)
        # The damper of the hinge acts on the rate by itself.
        force_n -= side * out_n - faster_n_s_m * hinge_rad_s * lever_m
        stiffness += deeper_n_m
        damping += faster_n_s_m
        about_hinge = stiffness * lever_m**2
        return about_hinge, damping * lever_m**2, hinge_rad + force_n * lever_m / about_hinge


class JointLocks:
    """The two articulation joints: the valve turns a rest angle, bounded by the torque.

    Our plant has metal stops beyond the largest angle; no manoeuvre comes to them.
    """

    def __init__(self, machine: Machine):
        a, v = machine.articulation, machine.vehicle
        self._rate_rad_s = math.radians(a.rate_max_deg_s)
        self._angle_max_rad = math.radians(a.angle_max_deg)
        self._twist_rad = a.torque_max_nm / v.joint_stiffness_nm
        self.stiffness_nm = v.joint_stiffness_nm
        self.damping_nms = v.joint_damping_nms
        self.rest_rad = [0.0, 0.0]

    def step(self, joint: int, opening: float, angle_rad: float, rate_rad_s: float, dt_s: float):
        """Turns the rest angle and returns it."""
        rest = self.rest_rad[joint] + clamp(opening, -1.0, 1.0) * self._rate_rad_s * dt_s
        rest = clamp(rest, -self._angle_max_rad, self._angle_max_rad)
        there = angle_rad + rate_rad_s * dt_s
        self.rest_rad[joint] = clamp(rest, there - self._twist_rad, there + self._twist_rad)
        return self.rest_rad[joint]


class Drive:
    """Two circuits of three motors in parallel: equal torque, mean speed held."""

    def __init__(self, machine: Machine):
        w, d, v = machine.wheels, machine.drive, machine.vehicle
        self._circuits = machine.circuits()
        self._full_rad_s = d.speed_full_m_s / w.radius_m * FULL_DISPLACEMENT_SHARE
        self._engine_rpm = d.engine_speed_rpm
        self._engine_torque_nm = d.engine_torque_max_nm
        self._power_max_w = d.engine_power_w
        self._torque_max_nm = w.torque_max_nm
        self._gain_nms = v.circuit_gain_nms
        self._integral_nm = v.mean_integral_nm
        self._mean_nm = 0.0

    def step(self, pump: float, motor: float, engine_rpm: float, rate_rad_s, dt_s: float):
        """Torque on each wheel for pumps and motors that are all set alike, Nm."""
        target = self._full_rad_s * engine_rpm / self._engine_rpm * pump / motor
        means = [float(np.mean(rate_rad_s[circuit])) for circuit in self._circuits]
        bound = self._torque_max_nm
        circuit_nm = [
            clamp(self._mean_nm + self._gain_nms * (target - mean), -bound, bound)
            for mean in means
        ]
        torque_nm = np.zeros(len(WHEELS))
        for wheels, mean, shared_nm in zip(self._circuits, means, circuit_nm, strict=True):
            for wheel in wheels:
                off = rate_rad_s[wheel] - mean
                beyond = off - clamp(off, -SLIP_FREE_RAD_S, SLIP_FREE_RAD_S)
                torque_nm[wheel] = clamp(shared_nm - SLIP_GAIN_NMS * beyond, -bound, bound)
        scale = self._limit(engine_rpm, float(torque_nm @ rate_rad_s))
        error = target - sum(means) / 2.0
        full = scale < 1.0 or any(abs(nm) >= bound for nm in circuit_nm)
        if not (full and error * sum(circuit_nm) > 0.0):
            self._mean_nm = clamp(self._mean_nm + self._integral_nm * error * dt_s, -bound, bound)
        return torque_nm * scale

    def _limit(self, engine_rpm: float, wanted_w: float) -> float:
        available_w = min(self._power_max_w, self._engine_torque_nm * engine_rpm * math.tau / 60.0)
        return available_w / wanted_w if wanted_w > available_w else 1.0


def rolling_drag_nm(machine: Machine, normal_n: float, rate_rad_s: float) -> float:
    """Torque of the rolling resistance on a wheel, Nm."""
    w = machine.wheels
    full_nm = w.rolling_resistance * max(normal_n, 0.0) * w.radius_m
    return -full_nm * math.tanh(rate_rad_s / DRAG_FADE_RAD_S)
