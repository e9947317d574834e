"""Six valves, cylinders and their oil: from the opening asked for to the push of the cylinder."""

import math

import numpy as np

from xt28_mujoco.machine import Machine

from .line import Line
from .truth import N, Truth

# A seal bends by its breakaway before it slips (assumed): N/m of its bristles.
BRISTLE_N_M = 8.0e6
STRIBECK_M_S = 4.0e-3
# Oil column of an arm on its accumulator below the precharge, N/m (assumed).
OIL_N_M = 2.5e7
LEAK_AT_N = 5.0e4
LOAD_AT_N = 1.0e5


class Gas:
    """A polytropic accumulator behind a stiff column of oil: push over compression, as a table."""

    def __init__(self, precharge_pa: float, volume_m3: float, exponent: float, area_m2: float):
        push = np.linspace(0.0, 2.7e5, 1400)
        share = np.maximum(push / (precharge_pa * area_m2), 1.0)
        self._push = push
        self._squeeze = push / OIL_N_M + volume_m3 / area_m2 * (1.0 - share ** (-1.0 / exponent))

    def push_n(self, squeeze_m: float) -> float:
        """Push at a compression; oil alone where the gas pushes nothing."""
        if squeeze_m <= 0.0:
            return OIL_N_M * squeeze_m
        return float(np.interp(squeeze_m, self._squeeze, self._push))

    def squeeze_m(self, push_n: float) -> float:
        """Compression under a push."""
        if push_n <= 0.0:
            return push_n / OIL_N_M
        return float(np.interp(push_n, self._push, self._squeeze))


class Arms:
    """State of the six arms."""

    def __init__(self, machine: Machine, truth: Truth, stroke_m: list[float], dt_s: float):
        self._arms, self._dt_s = truth.arms, dt_s
        a, h = machine.arms, machine.hydraulics
        self._full_m_s, self._area_m2 = h.speed_full_m_s, a.area_bore_m2
        self._force_max_n, self._stroke_max_m = a.force_max_n, a.stroke_max_m
        self._line = [Line(dt_s) for _ in range(N)]
        self._slow, self._spool = [0.0] * N, [0.0] * N
        self._bristle_m = [0.0] * N
        self._gas = [
            Gas(p, truth.arms.volume_m3, truth.arms.exponent, self._area_m2) if p > 0.0 else None
            for p in truth.arms.precharge_pa
        ]
        load_n = 5.5e4
        self._rest_m = [
            s + (g.squeeze_m(load_n) if g else load_n / k)
            for s, g, k in zip(stroke_m, self._gas, truth.arms.stiffness_n_m, strict=True)
        ]
        # What the oil pushes, and what the rod does with the seal's friction in it, N.
        self.oil_n = [load_n] * N

    def _flow(self, i: int, asked: float, time_s: float) -> float:
        """Speed of the rod that the valve lets through, m/s."""
        a, dt = self._arms, self._dt_s
        command = self._line[i].step(asked, a.delay_s[i])
        self._slow[i] += (command - self._slow[i]) * min(1.0, dt / max(a.lag_s[i], dt))
        half = 0.5 * a.play[i]
        if abs(self._slow[i] - self._spool[i]) > a.stick[i]:
            self._spool[i] = min(
                max(self._spool[i], self._slow[i] - half), self._slow[i] + half
            )
        spool = self._spool[i]
        beyond = abs(spool) - a.deadband[i]
        if beyond <= 0.0:
            return 0.0
        share = beyond / (1.0 - a.deadband[i])
        side = a.extension[i] if spool > 0.0 else a.contraction[i]
        # A load hinders the rod on its way out and helps it back.
        hinders = 1.0 if spool > 0.0 else -1.0
        load = 1.0 - hinders * a.load_share[i] * self.oil_n[i] / LOAD_AT_N
        fade = 1.0 - a.fade * min(max(time_s, 0.0) / 30.0, 1.0)
        return math.copysign(share, spool) * side * max(load, 0.05) * fade * self._full_m_s

    def _friction_n(self, i: int, rate_m_s: float) -> float:
        """What the seal holds against the rod, N."""
        a = self._arms
        if a.coulomb_n[i] == 0.0 and a.breakaway_n[i] == 0.0:
            return 0.0
        more = a.breakaway_n[i] * math.exp(-((rate_m_s / STRIBECK_M_S) ** 2))
        bend_m = (a.coulomb_n[i] + more) / BRISTLE_N_M
        z = self._bristle_m[i] + rate_m_s * self._dt_s
        self._bristle_m[i] = min(max(z, -bend_m), bend_m)
        return BRISTLE_N_M * self._bristle_m[i]

    def step(self, asked, stroke_m, rate_m_s, time_s: float) -> list[float]:
        """Push of every rod, N, for openings asked for and how the rods stand and move."""
        a, dt = self._arms, self._dt_s
        flow = [self._flow(i, asked[i], time_s) for i in range(N)]
        wanted = sum(abs(f) for f in flow) * self._area_m2
        if wanted > a.pump_m3_s:
            flow = [f * a.pump_m3_s / wanted for f in flow]
        push = []
        for i in range(N):
            load_n = self.oil_n[i]
            rest = self._rest_m[i] + flow[i] * dt
            rest -= a.leak_m_s[i] * max(load_n, 0.0) / LEAK_AT_N * dt
            if load_n < a.sag_below_n:
                rest += a.sag_m_s[i] * dt
            gas, k = self._gas[i], a.stiffness_n_m[i]
            reach_m = self._force_max_n / k if gas is None else gas.squeeze_m(self._force_max_n)
            rest = min(max(rest, stroke_m[i] - reach_m, 0.0), stroke_m[i] + reach_m, a.stop_m[i])
            self._rest_m[i] = rest
            squeeze = rest - stroke_m[i]
            spring = k * squeeze if gas is None else gas.push_n(squeeze)
            self.oil_n[i] = spring - a.damping_n_s_m[i] * rate_m_s[i]
            push.append(self.oil_n[i] - self._friction_n(i, rate_m_s[i]))
        return push
