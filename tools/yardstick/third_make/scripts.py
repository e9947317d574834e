"""What the gateway commands in the test drives: strokes, throttle and front angle over time."""

import math
from dataclasses import dataclass, field

import numpy as np

from .truth import N

RAMP = {"x_m": [4.0, 7.0, 8.5, 11.5], "height_m": 0.3, "y_min_m": -1.9, "y_max_m": -0.5}


@dataclass
class Script:
    """Steps hold until the next one; swings are added to the strokes."""

    name: str
    seconds: float
    fit: bool
    base_mm: float = 170.0
    strokes: list = field(default_factory=list)
    swings: list = field(default_factory=list)
    throttle: list = field(default_factory=list)
    steer: list = field(default_factory=list)
    ramp: bool = False

    def at(self, time_s: float, _seen=None) -> tuple[list[int], float, float]:
        """Targets, mm in steps of 2; throttle, %; front angle, deg."""
        time_s = max(time_s, 0.0)

        def since(steps, first):
            return next((value for at, value in reversed(steps) if at <= time_s), first)

        base = since(self.strokes, [self.base_mm] * N)
        swing = [0.0] * N
        for i, terms in enumerate(self.swings):
            swing[i] = sum(a * math.sin(math.tau * f * time_s + p) for a, f, p in terms)
        target = [2 * round((b + s) / 2.0) for b, s in zip(base, swing, strict=True)]
        return target, since(self.throttle, 0.0), since(self.steer, 0.0)


def _level_on_ramp(script: Script) -> None:
    """Right arms drawn in as their wheels come onto the ramp, at half a metre a second or so."""
    pace_m_s = 0.01 * script.throttle[0][1] * 1.5
    events = []
    for k, axle_m in enumerate((0.0, 3.7, 6.05)):
        for share, at_m in ((0.5, 5.5), (1.0, 7.0), (0.5, 10.0), (0.0, 11.5)):
            events.append((1.5 + (at_m + axle_m) / pace_m_s, 2 * k, script.base_mm - 70.0 * share))
    now = [script.base_mm] * N
    for at_s, wheel, mm in sorted(events):
        now = [mm if w == wheel else before for w, before in enumerate(now)]
        script.strokes.append((at_s, now))


def drives(random: np.random.Generator) -> list[Script]:
    """The six drives of a case, a little different each time."""

    def about(value: float, by: float) -> float:
        return value + by * random.uniform(-1.0, 1.0)

    def sines(mm: float):
        terms = ((0.06, 1.0), (0.15, 0.8), (0.33, 0.5), (0.6, 0.3))
        return [
            [(mm * a * about(1.0, 0.2), f * about(1.0, 0.15), about(0.0, 3.1)) for f, a in terms]
            for _ in range(N)
        ]

    low = about(60.0, 20.0)
    step = Script("arm_step", 32.0, True, low)
    for at, mm in ((2.4, 200.0), (9.0, 370.0), (17.0, 200.0), (24.0, low)):
        level = about(mm, 15.0) if mm != low else low
        step.strokes.append((about(at, 0.4), [level, level, low, low, level, level]))
    single = Script("single_arm", 36.0, True)
    for k, w in enumerate(random.permutation(N)):
        up = [220.0 if i == w else 170.0 for i in range(N)]
        single.strokes += [(1.8 + 5.8 * k, up), (4.8 + 5.8 * k, [170.0] * N)]
    multisine = Script("multisine", 30.0, True, 180.0, swings=sines(14.0))
    turn = Script("s_turn", 30.0, True)
    turn.throttle = [(1.9, about(55.0, 5.0)), (28.0, 0.0)]
    turn.steer = [(4.5, about(16.0, 2.0)), (13.0, about(-16.0, 2.0)), (23.0, about(8.0, 2.0))]
    straight = Script("straight", 30.0, False)
    levels = ((1.9, 60.0), (9.0, 85.0), (15.0, 30.0), (19.5, 65.0), (27.5, 0.0))
    straight.throttle = [(at, about(p, 5.0) if p else 0.0) for at, p in levels]
    ramp = Script("ramp", 30.0, True, 210.0, ramp=True)
    ramp.throttle = [(1.0, about(50.0, 4.0)), (26.0, 0.0)]
    _level_on_ramp(ramp)
    mixed = Script("mixed", 32.0, False, 150.0, swings=sines(16.0))
    mixed.throttle = [(2.0, about(50.0, 5.0)), (12.0, 75.0), (20.0, 40.0), (29.0, 0.0)]
    mixed.steer = [(4.0, -12.0), (10.0, 10.0), (18.0, 0.0), (23.0, about(-14.0, 2.0))]
    arms = single if random.random() < 0.5 else multisine
    return [step, arms, turn, straight, ramp, mixed]
