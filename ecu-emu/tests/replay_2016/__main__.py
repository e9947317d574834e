"""Replays a log of the emulator's 2016 profile against calculations of its own.

python3 replay_2016 DATABASE LOG INPUTS

LOG is a candump log with a wire's name for each frame; INPUTS a table of what was on the ECUs' pins
at every tick. Every frame is decoded by cantools; which frames must come, how often and on which
wire is checked; and every signal that an ECU sends is compared with what the published formulas
make of the voltages and of the frames that reached it. Prints how far each message was off at worst
and exits with 1 if anything is beyond its tolerance.
"""

import csv
import sys
from collections import Counter, defaultdict

import cantools
from arm_ecu import ArmEcu
from drive_ecu import DriveEcu

# Counts of its resolution by which a signal may be off: where a sine or a sum of fractions ends on
# a whole number, another order or another libm may cut it to the other side. All else must be exact.
TOLERANCE = {
    "WheelForce": 1, "OptLoad": 1, "ForceErr": 1, "CentreOfMass": 1, "Attitude": 1,
    "RefCurrent": 1, "ActCurrent": 1,
}  # fmt: skip
# Values that may be off at all, within their tolerance, as a share of all.
INEXACT_MAX = 0.005
TICK_MS = 10
# What the run must have shown, or the comparison proves little: values seen, and least ranges.
SEEN = {
    ("ArmDisplay", "Levelling"): {0, 1},
    ("ArmDisplay", "Alert"): {0, 1},
    ("ArmDisplay", "Passive"): {0, 1},
    ("ArmDebug1", "Preset"): {0, 3},
    ("MachineStatus", "DriveMode"): {1, 4, 16},
    ("MachineStatus", "TurnMode"): {1, 16, 64},
    ("MachineStatus", "ParkingBrake"): {0, 4},
}
SPAN = {
    ("Attitude", "Roll"): 2, ("Attitude", "Pitch"): 1, ("ArmDisplay", "HeightReference"): 280,
    ("PosFront", "FR"): 60, ("WheelForceFront", "FR"): 2000, ("VelFront", "FR"): 40,
    ("DriveCurrent", "Pump1A"): 250, ("DriveCurrent", "Pump1B"): 600,
    ("DriveCurrent", "SteerFrontA"): 500, ("DriveCurrent", "SteerFrontB"): 500,
    ("DriveCurrent", "SteerRearA"): 420, ("DriveCurrent", "SteerRearB"): 420,
    ("MotorCurrent", "Motor1"): 150, ("DriveDebug5", "Demand2"): 300,
    ("WheelSpeed", "Wheel1"): 8, ("WheelSpeedJoint", "FrontJoint"): 5,
    ("MachineStatus", "EngineSpeed"): 300, ("MachineService", "SpeedLimit"): 5,
} | {(f"RefCurrent{axle}", f"{wheel}_{side}"): 420
     for axle, wheels in (("Front", "FR FL"), ("Mid", "MR ML"), ("Rear", "BR BL"))
     for wheel in wheels.split() for side in "AB"}  # fmt: skip
PER_TICK = {"can1": 32 + 13, "display": 3 + 2, "engine": 1, "inertial": 2}


def words(data):
    """Signed little-endian words."""
    return [int.from_bytes(data[i : i + 2], "little", signed=True) for i in range(0, len(data), 2)]


def pressed(decoded):
    """Numbers of the buttons down."""
    return {int(name[len("Button") :]) for name, value in decoded.items() if value == 1}


class Wire:
    """What reached the ECUs on wires of their own in one tick."""

    def __init__(self):
        self.imu, self.left, self.right, self.engine = {}, {}, {}, {}


def read(database, log):
    """Frames by tick: wire, message, signals; and the raw ones of the inertial unit's wire."""
    ticks = defaultdict(list)
    for line in open(log):
        stamp, wire, frame = line.split()
        at_ms = round(float(stamp[1:-1]) * 1000)
        assert at_ms % TICK_MS == 0, line
        text, data = frame.split("#")
        ticks[at_ms // TICK_MS].append((wire, int(text, 16), len(text) > 3, bytes.fromhex(data)))
    return [ticks[n] for n in range(max(ticks) + 1)]


class Replay:
    """Both calculated ECUs beside the log."""

    def __init__(self, database):
        self.database = database
        self.messages = {
            (m.frame_id & 0x1FFFFFFF, m.is_extended_frame): m for m in database.messages
        }
        self.arm, self.drive = ArmEcu(), DriveEcu()
        self.status = (0, 0)
        self.worst, self.checked = defaultdict(float), Counter()
        self.off, self.bad = 0, []
        self.last = {}
        self.values = defaultdict(set)

    def tick(self, n, frames, volts):
        """One tick: decode, sort out what the ECUs heard, calculate, compare."""
        heard, said = Wire(), []
        per_wire = Counter(wire for wire, *_ in frames)
        for wire, wanted in PER_TICK.items():
            extra = (n % 2 == 0) + (n % 5 == 0) + (n % 100 == 0) if wire == "engine" else 0
            extra += wire == "inertial" and n == 0
            if per_wire[wire] != wanted + extra:
                self.bad.append(f"tick {n}: {per_wire[wire]} frames on {wire}")
        for wire, number, extended, data in frames:
            if wire == "inertial":
                if number == 0x1FD and not extended:
                    heard.imu["rates"] = words(data)
                elif number == 0x2FD and not extended:
                    # The unit sends Y before X (2.3); the arm ECU's copy has X first.
                    y, x, z = words(data)
                    heard.imu["acc"] = (x, y, z)
                elif (number, n, data) != (0, 0, b"\x01\x7f"):
                    self.bad.append(f"tick {n}: {number:X} on the inertial unit's wire")
                continue
            message = self.messages[number, extended]
            assert len(data) == message.length, f"{message.name}: {len(data)} bytes"
            decoded = message.decode(data, decode_choices=False)
            self.period(n, wire, message)
            self.sort(wire, message.name, decoded, heard, said)
        status = self.status
        imu = (*heard.imu["rates"], *heard.imu["acc"])
        left = heard.left and (heard.left["b"], heard.left["x"], heard.left["y"])
        right = heard.right and (heard.right["b"], heard.right["steer"], heard.right["roller"])
        wanted = self.arm.step(volts, imu, left, status)
        wanted |= self.drive.step(volts, right, heard.engine)
        for name, decoded in said:
            for signal, value in decoded.items():
                self.compare(n, name, signal, value, wanted[name, signal])
            if name == "MachineStatus":
                self.status = (decoded["ParkingBrake"], decoded["Chair"])

    def sort(self, wire, name, decoded, heard, said):
        """Who sent it: an armrest, the engine, or one of the ECUs."""
        if wire == "left":
            part = {"LeftPadJoystickX": ("x", "X"), "LeftPadJoystickY": ("y", "Y")}.get(name)
            heard.left |= {part[0]: decoded[part[1]]} if part else {"b": pressed(decoded)}
        elif wire == "right":
            part = {"RightPadJoystick": ("steer", "X"), "RightPadRoller": ("roller", "Roller")}
            part = part.get(name)
            heard.right |= {part[0]: decoded[part[1]]} if part else {"b": pressed(decoded)}
        elif name == "EEC1":
            heard.engine["rpm"] = decoded["EngineSpeed"]
        elif name == "EEC2":
            heard.engine["load"] = decoded["Load"]
        elif name == "ET1":
            heard.engine["coolant"] = decoded["Coolant"]
        else:
            said.append((name, decoded))

    def period(self, n, wire, message):
        """A message comes at the cycle time that the database gives it, on its wire."""
        last = self.last.get((wire, message.name))
        self.last[wire, message.name] = n
        if last is None or last == n or (wire in ("left", "right") and n - last > 50):
            return  # first, twice in a tick (counted above), or after a silence of the armrests
        if (n - last) * TICK_MS != message.cycle_time:
            self.bad.append(f"tick {n}: {message.name} after {n - last} ticks on {wire}")

    def compare(self, n, name, signal, got, wanted):
        """Within so many counts of the signal's resolution."""
        scale = self.database.get_message_by_name(name).get_signal_by_name(signal).scale
        counts = abs(got - wanted) / scale
        self.worst[name] = max(self.worst[name], counts)
        self.checked[name] += 1
        self.values[name, signal].add(got)
        self.off += counts > 1e-6
        allowed = next((t for start, t in TOLERANCE.items() if name.startswith(start)), 0)
        if counts > allowed + 1e-6:
            self.bad.append(f"tick {n}: {name}.{signal} is {got}, calculated {wanted}")


    def unshown(self):
        """What the run should have shown and did not."""
        for place, wanted in SEEN.items():
            if self.values[place] != wanted:
                yield f"{place} took {sorted(self.values[place])}, not {sorted(wanted)}"
        for place, wanted in SPAN.items():
            span = max(self.values[place]) - min(self.values[place])
            if span < wanted:
                yield f"{place} spanned {span:.2f}, not {wanted}"


def main(database, log, inputs):
    """Returns the exit code."""
    replay = Replay(cantools.database.load_file(database))
    table = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(open(inputs))]
    ticks = read(database, log)
    assert len(ticks) == len(table), f"{len(ticks)} ticks logged, {len(table)} ticks of inputs"
    for n, (frames, volts) in enumerate(zip(ticks, table)):
        replay.tick(n, frames, volts)
    for name in sorted(replay.worst):
        print(f"{name:18} {replay.checked[name]:7} values, off by {replay.worst[name]:.0f} at worst")
    replay.bad.extend(replay.unshown())
    checked = sum(replay.checked.values())
    share = replay.off / checked
    print(f"{sum(map(len, ticks))} frames, {checked} values, {replay.off} off within tolerance")
    for line in replay.bad[:20]:
        print(line)
    if share > INEXACT_MAX:
        print(f"{share:.2%} of the values are not exact")
    return bool(replay.bad) or share > INEXACT_MAX


sys.exit(main(*sys.argv[1:]))
