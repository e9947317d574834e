"""Steering valves with their joints, and the hydrostatic drive with its engine."""

import math

import numpy as np

from xt28_mujoco.machine import Machine

from .line import Line
from .truth import N, Truth

SLIP_FREE_RAD_S = 4.0 * math.tau / 60.0
SLIP_GAIN_NMS = 6.0e3
HOLD_NM_RAD = 2.0e6
FADE_RAD_S = 0.05
# How often a second an engine sways whose governor hunts (assumed).
SURGE_HZ = 0.7
# Below this throttle idle motors may hold their wheels.
SHUT = 0.01


class Joints:
    """Two joints, each a rest angle that its valve turns and a stiff cylinder about it."""

    def __init__(self, machine: Machine, truth: Truth, dt_s: float):
        a, v = machine.articulation, machine.vehicle
        self._truth, self._dt_s = truth.steering, dt_s
        self._rate = math.radians(a.rate_max_deg_s)
        self._twist = a.torque_max_nm / v.joint_stiffness_nm
        self._stiffness, self._damping = v.joint_stiffness_nm, v.joint_damping_nms
        self._rest = [0.0, 0.0]
        self._slow = [0.0, 0.0]
        self._line = [Line(dt_s) for _ in range(2)]

    def step(self, opening, angle_rad, rate_rad_s) -> list[float]:
        """Torque on both joints, Nm."""
        t, dt, torque = self._truth, self._dt_s, []
        play, lags = math.radians(t.play_deg) / 2.0, (t.lag_s, t.lag_s + t.rear_lag_s)
        for j in range(2):
            asked = self._line[j].step(opening[j], t.delay_s)
            self._slow[j] += (asked - self._slow[j]) * min(1.0, dt / max(lags[j], dt))
            side = t.right_rate if self._slow[j] < 0.0 else 1.0
            rest = self._rest[j] + self._slow[j] * self._rate * t.rate * side * dt
            reach = self._twist + play
            self._rest[j] = rest = min(max(rest, angle_rad[j] - reach), angle_rad[j] + reach)
            twist = rest - angle_rad[j]
            held = math.copysign(max(abs(twist) - play, 0.0), twist)
            loose = play > 0.0 and held == 0.0
            damping = self._damping * (0.1 if loose else 1.0)
            torque.append(self._stiffness * held - damping * rate_rad_s[j])
        return torque


class Drive:
    """Engine, two circuits of three motors, and what resists the wheels."""

    def __init__(self, machine: Machine, truth: Truth, dt_s: float):
        self._truth, self._dt_s = truth.drive, dt_s
        w, d, v = machine.wheels, machine.drive, machine.vehicle
        self._circuits = machine.circuits()
        self._full_rad_s = d.speed_full_m_s / w.radius_m
        self._bound_nm = w.torque_max_nm
        self._gain, self._integral = v.circuit_gain_nms, v.mean_integral_nm
        self._rpm = d.engine_speed_rpm
        self._mean_nm, self._target = 0.0, 0.0
        self._line = Line(dt_s)
        self._held_rad: list[float | None] = [None] * N
        self.circuit_nm = [0.0, 0.0]
        self.engine_rpm = d.engine_speed_rpm
        self._power_w = 0.0
        self._radius_m = w.radius_m

    def step(self, throttle: float, angle, rate, normal_n, time_s: float):
        """Torques on every wheel, Nm: between it and its arm, and of the ground."""
        t, dt, bound = self._truth, self._dt_s, self._bound_nm
        pedal = self._line.step(throttle, t.delay_s)
        asked = math.copysign(abs(pedal) ** t.curve, pedal) * self._full_rad_s
        self.engine_rpm = self._rpm * (1.0 - min(t.droop_per_w * max(self._power_w, 0.0), 0.6))
        self.engine_rpm *= 1.0 + t.surge * math.sin(math.tau * SURGE_HZ * time_s)
        asked *= self.engine_rpm / self._rpm
        self._target += (asked - self._target) * min(1.0, dt / t.lag_s)
        means = [sum(rate[w] for w in c) / 3.0 for c in self._circuits]
        error = self._target - sum(means) / 2.0
        circuit = [
            min(max(self._mean_nm + self._gain * (self._target - m), -bound), bound) for m in means
        ]
        circuit[1] *= t.second_circuit
        motor = [0.0] * N
        for wheels, mean, nm in zip(self._circuits, means, circuit, strict=True):
            for w in wheels:
                off = rate[w] - mean
                over = off - min(max(off, -SLIP_FREE_RAD_S), SLIP_FREE_RAD_S)
                motor[w] = min(max(nm - SLIP_GAIN_NMS * over, -bound), bound)
        wanted = sum(motor[w] * rate[w] for w in range(N))
        scale = t.power_w / wanted if wanted > t.power_w else 1.0
        self._power_w += (wanted * scale - self._power_w) * min(1.0, dt / 0.1)
        full = scale < 1.0 or any(abs(nm) >= bound for nm in circuit)
        if not (full and error * sum(circuit) > 0.0):
            self._mean_nm += self._integral * error * dt
            self._mean_nm = min(max(self._mean_nm, -bound), bound)
        self.circuit_nm = [nm * scale for nm in circuit]
        motor = [nm * scale for nm in motor]
        self._hold(motor, pedal, angle, rate)
        drag = self._drag(angle, rate, normal_n)
        if t.in_bearings:
            return [nm + by for nm, by in zip(motor, drag, strict=True)], [0.0] * N
        return motor, drag

    def _hold(self, motor, pedal, angle, rate) -> None:
        for w, most in enumerate(self._truth.hold_nm):
            if most == 0.0:
                continue
            if abs(pedal) > SHUT:
                self._held_rad[w] = None
                continue
            held = self._held_rad[w]
            held = angle[w] if held is None else held
            reach = most / HOLD_NM_RAD
            held = min(max(held, angle[w] - reach), angle[w] + reach)
            self._held_rad[w] = held
            motor[w] += HOLD_NM_RAD * (held - angle[w]) - 2.0e3 * rate[w]

    def _drag(self, angle, rate, normal_n) -> list[float]:
        drag = []
        for w in range(N):
            full = self._truth.rolling[w] * max(normal_n[w], 0.0) * self._radius_m
            if self._truth.flat_nm[w] > 0.0 and math.sin(angle[w]) > 0.8:
                full += self._truth.flat_nm[w]
            drag.append(-full * math.tanh(rate[w] / FADE_RAD_S))
        return drag


def pump_bar(circuit_nm) -> np.ndarray:
    """Pressures of both pumps, sides A and B each, bar."""
    sides = []
    for nm in circuit_nm:
        sides += [25.0 + 350.0 * max(-nm, 0.0) / 20e3, 25.0 + 350.0 * max(nm, 0.0) / 20e3]
    return np.array(sides)
