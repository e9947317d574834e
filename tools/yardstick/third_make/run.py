"""One run: gateway, bus, both ECUs and the machine, everything on the bus written down."""

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from xt28_mujoco.machine import WHEELS, Linkage, Machine
from xt28_mujoco.terrain import Block

from .arms import Arms
from .body import RATE_HZ, Body, heading
from .drive import Drive, Joints, pump_bar
from .ecu import TICK_S, ArmEcu, DriveEcu
from .policy import Policy, Seen
from .scripts import RAMP, Script
from .sensing import Sensors, specific_force
from .truth import N, Truth
from .wire import Wire

SETTLE_S = 5.0
# When either ECU's task runs after the command, and when the engine speaks, s.
ARM_S, DRIVE_S, ENGINE_S = 0.002, 0.005, 0.008
STEPS = round(TICK_S * RATE_HZ)
ARM_FRAMES = {
    "PressRear": ("BR", "BL"),
    "PressMid": ("MR", "ML"),
    "PressFront": ("FR", "FL"),
}


class Run:
    """Everything that goes on in a drive."""

    def __init__(
        self, machine: Machine, dbc: Path, truth: Truth, faults, script: Script | Policy, random
    ):
        self._faults = sorted(faults, key=lambda fault: fault.start_s)
        self._set_in(truth, 0.0)
        self._machine, self._truth, self._script, self._random = machine, truth, script, random
        first, _, _ = script.at(0.0)
        strokes = [mm * 1e-3 for mm in first]
        dt = 1.0 / RATE_HZ
        self.body = Body(machine, truth, _ramp() if script.ramp else None, strokes)
        self._arms = Arms(machine, truth, strokes, dt)
        self._joints, self._drive = Joints(machine, truth, dt), Drive(machine, truth, dt)
        self._arm_ecu, self._drive_ecu = ArmEcu(truth), DriveEcu(machine, truth)
        self._sensors, self._wire = Sensors(machine, truth, random), Wire(dbc)
        # The ECU reckons wheel forces with a cylinder that is 30 mm shorter (facts 1.4).
        self._told = Linkage(SimpleNamespace(**vars(machine.arms) | {"closed_length_m": 0.82}))
        self._heard = script.at(0.0)
        self._underway: list = []
        self._steer, self._openings = [0.0, 0.0], [0.0] * N
        self._before = np.zeros(3)
        self._rpm, self._fixes = np.zeros(N), 0
        self._seen: Seen | None = None

    def log(self, begin_s: float) -> bytes:
        """Drives the script and returns its log."""
        settle = round(SETTLE_S / TICK_S)
        for tick in range(settle + round(self._script.seconds / TICK_S)):
            self._tick((tick - settle) * TICK_S, tick - settle)
        return self._wire.log(begin_s)

    def _set_in(self, truth: Truth, now_s: float) -> bool:
        """Makes true what has set in by now; whether anything has that had not."""
        due = [fault for fault in self._faults if fault.start_s <= now_s]
        for fault in due:
            fault.put_in(truth)
        self._faults = self._faults[len(due) :]
        return bool(due)

    def _tick(self, now_s: float, tick: int) -> None:
        if self._set_in(self._truth, now_s):
            self.body.become(self._truth)
        self._command(now_s, tick)
        for step in range(STEPS):
            if step == round(ARM_S * RATE_HZ):
                self._arm(now_s, tick)
            if step == round(DRIVE_S * RATE_HZ):
                self._steering(now_s, tick)
            self._step(now_s + step / RATE_HZ)
        if tick >= 0 and tick % 5 == 0:
            speed = {"EngineSpeed": self._drive.engine_rpm}
            self._wire.send(now_s + ENGINE_S, self._wire.encode("EEC1", speed))

    def _command(self, now_s: float, tick: int) -> None:
        target, throttle, steer = command = self._script.at(now_s, self._seen)
        bus, draw = self._truth.bus, self._random.random(3)
        arrives = [tick < 0 or share >= bus.loss for share in draw[1:]]
        at_s = now_s + bus.late_s * draw[0]
        if self._underway:
            at_s = max(at_s, self._underway[-1][0])
        self._underway.append((at_s, command, arrives))
        frames = (
            self._wire.encode(
                "ArmTarget", {**dict(zip(WHEELS, target, strict=True)), "Mode": 2}, 0x4027
            ),
            self._wire.encode(
                "DriveTarget",
                {"Throttle": throttle, "FrontAngle": steer, "EngineSpeed": 1200, "Enable": 1},
                0x4127,
            ),
        )
        if tick >= 0:
            for k, frame in enumerate(frames):
                if arrives[k]:
                    self._wire.send(at_s + k * 140e-6, frame)
        turn, place, velocity, _ = self.body.front(self._sensors.antenna_m())
        self._sensors.watch(now_s, (place, velocity, heading(turn)))
        if tick >= 0 and tick * 2 >= self._fixes * 25:
            self._fixes += 1
            self._wire.send(now_s + 300e-6, *self._fix(now_s))

    def _fix(self, now_s: float) -> list[str]:
        place, velocity, course = self._sensors.fix(now_s)
        self._seen = Seen((place[0], place[1]), course, *self._arm_ecu.attitude_deg())
        encode = self._wire.encode
        east, north, up = velocity * 1e3
        return [
            encode("GnssPosition", {"East": place[0] * 1e3, "North": place[1] * 1e3}),
            encode(
                "GnssVelocity",
                {"East": east, "North": north, "Up": up, "Heading": math.degrees(course) % 360.0},
            ),
            encode("GnssQuality", {"Fix": 4, "Satellites": 14, "Accuracy": 10, "Latency": 2}),
        ]

    def _arm(self, now_s: float, tick: int) -> None:
        while self._underway and self._underway[0][0] <= now_s + ARM_S:
            _, (target, throttle, steer), arrives = self._underway.pop(0)
            old_target, old_throttle, old_steer = self._heard
            self._heard = (
                target if arrives[0] else old_target,
                throttle if arrives[1] else old_throttle,
                steer if arrives[1] else old_steer,
            )
        ecu = self._arm_ecu
        stroke_m, _, _ = self.body.strokes()
        turn, _, velocity, rate = self.body.front((0.0, 0.0, 1.0))
        felt = specific_force((velocity - self._before) / TICK_S, turn, self.body.model.opt.gravity)
        self._before = velocity
        strokes = self._sensors.strokes_mm(stroke_m)
        pressures = self._sensors.pressures_kpa(self._arms.oil_n)
        ecu.tick(self._heard[0], strokes, pressures, self._sensors.inertial(felt, rate))
        self._openings = ecu.openings()
        if tick >= 0:
            self._wire.send(now_s + ARM_S, *self._arm_frames(strokes, tick))

    def _arm_frames(self, strokes, tick: int) -> list[str]:
        ecu, encode, frames = self._arm_ecu, self._wire.encode, []
        bore, rod = self._machine.arms.area_bore_m2, self._machine.arms.area_rod_m2
        kpa = ecu.pressure_kpa
        for name, wheels in ARM_FRAMES.items():
            sides = {}
            for wheel in wheels:
                i = WHEELS.index(wheel)
                sides |= {f"{wheel}_A": kpa[2 * i], f"{wheel}_B": kpa[2 * i + 1]}
            frames.append(encode(name, sides))
        read = dict(zip(WHEELS, strokes, strict=True))
        frames += [encode("PosMidRear", read), encode("PosFront", read)]
        if tick % 5 == 0:
            load, push = {}, {}
            for i, wheel in enumerate(WHEELS):
                newton = (kpa[2 * i] * bore - kpa[2 * i + 1] * rod) * 1e3
                angle = self._told.angle_rad(strokes[i] * 1e-3)
                load[wheel] = newton / 10.0
                push[wheel] = load[wheel] * self._told.lever_m(angle) / self._told.reach_m(angle)
            frames += [encode(n, load) for n in ("CylLoadMidRear", "CylLoadFront")]
            frames += [encode(n, push) for n in ("WheelForceMidRear", "WheelForceFront")]
        roll, pitch = ecu.attitude_deg()
        tilt = {"Roll": roll, "Pitch": pitch, "MeanStroke": sum(strokes) / N}
        frames.append(encode("Attitude", tilt))
        currents = {}
        for wheel, ma in zip(WHEELS, ecu.current_ma, strict=True):
            currents[f"{wheel}_A"] = 400 - ma if ma < 0 else 0
            currents[f"{wheel}_B"] = 400 + ma if ma > 0 else 0
        names = ("RefCurrentFront", "RefCurrentMid", "RefCurrentRear")
        return frames + [encode(name, currents) for name in names]

    def _steering(self, now_s: float, tick: int) -> None:
        angle, _ = self.body.joints()
        _, rate = self.body.wheels()
        joints, rpm = self._sensors.joints_deg(angle), self._sensors.wheels_rpm(rate)
        ecu, encode = self._drive_ecu, self._wire.encode
        ecu.tick(self._heard[2], joints, rpm)
        self._steer = ecu.opening
        if tick < 0:
            return
        frames = []
        if tick % 5 == 0:
            sides = ("Pump1_A", "Pump1_B", "Pump2_A", "Pump2_B")
            bars = pump_bar(self._drive.circuit_nm)
            frames.append(encode("PumpPressure", dict(zip(sides, bars, strict=True))))
        slow = {"Wheel5": abs(rpm[4]), "Wheel6": abs(rpm[5])}
        frames.append(
            encode("WheelSpeedJoint", slow | {"FrontJoint": joints[0], "RearJoint": joints[1]})
        )
        if tick % 2 == 0:
            currents = {}
            for side, opening in zip(("SteerFront", "SteerRear"), ecu.opening, strict=True):
                ma = 415.0 + 315.0 * abs(opening) if abs(opening) >= 0.004 else 0.0
                currents[side + ("A" if opening > 0.0 else "B")] = 3.0 * round(ma / 3.0)
            frames.append(encode("DriveCurrent", currents))
        frames.append(encode("WheelSpeedSigned", dict(zip(WHEELS, rpm, strict=True))))
        self._wire.send(now_s + DRIVE_S, *frames)

    def _step(self, now_s: float) -> None:
        body = self.body
        stroke_m, rate_m_s, levers = body.strokes()
        push = self._arms.step(self._openings, stroke_m, rate_m_s, now_s)
        arm_nm = [p * lever for p, lever in zip(push, levers, strict=True)]
        joint_nm = self._joints.step(self._steer, *body.joints())
        throttle = self._heard[1] / 100.0
        wheel_nm, ground_nm = self._drive.step(
            throttle, *body.wheels(), body.normal_n(), now_s
        )
        body.step(arm_nm, joint_nm, wheel_nm, ground_nm)


def _ramp() -> Block:
    foot, crest, end, out = RAMP["x_m"]
    top, below = RAMP["height_m"], -0.5
    outline = ((foot, 0.0), (crest, top), (end, top), (out, 0.0), (foot, below), (out, below))
    sides = (RAMP["y_min_m"], RAMP["y_max_m"])
    return Block(corners_m=tuple((x, y, z) for y in sides for x, z in outline))
