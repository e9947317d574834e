"""The drive ECU of 2016, calculated from the published formulas alone: voltages in, signals out.

Shares no line with the emulator. Section numbers are those of the facts about the public firmware.
"""

from math import pi, trunc

from arm_ecu import WHEELS, mv

PUMPS = ["Pump1_A", "Pump1_B", "Pump2_A", "Pump2_B"]
CIRCUIT = [1, 2, 2, 1, 2, 1]  # motors 1, 4, 6 on pump 1 (1.3)
PEDALS = {"gas": (535, 4532), "brake": (538, 4535)}  # front set (4.2)
JOINTS = {"front": (1727, 3296, 4509), "rear": (867, 2244, 3464)}
NEUTRAL, FORWARD, REVERSE, OVERDRIVE = 1, 4, 16, 0


def keep(hz):
    """First-order filter at 100 Hz (4.5)."""
    rc = 1 / (2 * pi * hz)
    return rc / (rc + 0.01)


def quotient(a, b):
    """Whole division as C does it."""
    return trunc(a / b)


class DriveEcu:
    """All that the ECU keeps from tick to tick."""

    def __init__(self):
        self.tick = -1
        self.pedal = 0.0
        self.limit, self.offset = 500, 0.0
        self.state, self.braked, self.turn = NEUTRAL, False, 1
        self.turn_pressed = False
        self.mode, self.latched, self.down = None, None, False
        self.buttons, self.steer, self.roller = set(), 0, 0
        self.slip = [0] * 6
        self.regulating, self.integral = False, 0.0
        self.e_sum, self.side = 0.0, None
        self.front, self.rear = [0, 0], [0, 0]
        self.armed = False
        self.rpm = self.load = 0
        self.coolant, self.coolant_sum = -40, 0

    def step(self, volts, pad, engine):
        """One tick: voltages by name, pad frames and engine frames of the tick."""
        self.tick += 1
        if pad:
            self.buttons, self.steer, self.roller = pad
        self.rpm, self.load = engine.get("rpm", self.rpm), engine.get("load", self.load)
        if "coolant" in engine:
            self.coolant = engine["coolant"]
            self.coolant_sum += self.coolant + 41
        said = {}
        joint = [self.joint(volts, name) for name in JOINTS]
        pressure = [
            max(0, min(60000, (mv(volts[p]) - 500) * 15)) for p in PUMPS
        ]
        self.filter_pedal(volts)
        counts = self.counts(volts)
        mean = max(1, trunc(sum(counts) / 6))
        said["EngineRequest", "Mode"], said["EngineRequest", "Speed"] = 1, self.request()
        self.press()
        self.offset = self.offset - 2 if self.load > 60 else min(0.0, self.offset + 0.5)
        self.drive(pressure, counts, mean, said)
        self.steering(joint, mean, said)
        self.show(joint, pressure, counts, mean, said)
        return said

    def joint(self, volts, name):
        """0.01 deg, piecewise linear (4.6)."""
        right, straight, left = JOINTS[name]
        above = mv(volts["joint_" + name]) - straight
        span = straight - right if above < 0 else left - straight
        return max(-2500, min(2500, trunc(above * 2500 / span)))

    def filter_pedal(self, volts):
        """Gas less brake, 3.18 s (4.2)."""
        share = {
            name: max(0.0, min(1000.0, 1000 * (mv(volts[name]) - low) / (high - low)))
            for name, (low, high) in PEDALS.items()
        }
        pedal = 0.9968682 * self.pedal + 0.0031318 * (share["gas"] - share["brake"])
        self.pedal = max(0.0, min(1000.0, pedal))

    def counts(self, volts):
        """Hundredths of rpm from tenths of Hz; inputs 5 and 6 crossed (4.8)."""
        raw = [trunc(volts[f"hz_{w}"] * 10) for w in WHEELS]
        counts = [trunc(trunc(f * 600 / 67) / 48.3) for f in raw]
        counts[4], counts[5] = counts[5], counts[4]
        return counts

    def request(self):
        """Roller to rpm, once it was at its start after 2 s (4.9)."""
        if self.tick >= 200 and self.roller < 222:
            self.armed = True
        if not self.armed:
            return 800
        return max(800, min(1800, 2000 + quotient((self.roller - 4500) * 1200, 4298)))

    def press(self):
        """Buttons (4.3, 4.4, 4.6, 4.7), by the toggle rule of 3.8."""
        down = bool(self.buttons)
        if down and not self.down:
            (button,) = self.buttons
            self.mode = None if button == self.latched else button
        if self.down and not down:
            self.latched = self.mode
        self.down = down
        states = {10: REVERSE, 11: NEUTRAL, 12: FORWARD, 21: OVERDRIVE}
        if self.mode in (19, 20) and down:
            step = 1 if self.mode == 19 else -1
            self.limit = max(100, min(1000, self.limit + step))
            return
        if self.mode == 9:
            self.regulating = not self.regulating
        elif self.mode in states and self.pedal <= 150:
            if states[self.mode] != self.state:
                self.state, self.e_sum = states[self.mode], 0.0
        elif self.mode == 16 and self.pedal < 150:
            self.braked = not self.braked
        elif self.mode in (13, 14, 15):
            believed = self.turn if self.turn_pressed else 16
            self.turn_pressed = True
            self.turn = {13: 1, 14: 4}.get(self.mode, 64 if believed == 16 else 16)
        self.mode = None

    def drive(self, pressure, counts, mean, said):
        """Sections 4.4 and 4.5."""
        second = self.pedal
        if self.regulating:
            integral = self.integral + (pressure[0] - pressure[2]) * 0.01
            self.integral = max(-125000.0, min(125000.0, integral))
            second = max(0.0, min(1000.0, self.pedal + 0.0004 * self.integral))
        else:
            self.integral = 0.0
        limit = max(100, self.limit + self.offset)
        demand = {1: trunc(self.pedal * limit / 1000), 2: trunc(second * limit / 1000)}
        shares = {
            c: (1000, trunc(333333 / d)) if d > 333.3 else (3 * d, 1000) for c, d in demand.items()
        }
        a = keep(0.10 if mean <= 500 else 0.02)
        self.slip = [trunc(a * x + (1 - a) * 2 * (n - mean)) for x, n in zip(self.slip, counts)]
        pump = {1: [0, 0], 2: [0, 0]}
        motors = []
        for m in range(6):
            epsilon = shares[CIRCUIT[m]][1] - (0 if self.regulating else self.slip[m])
            if self.state == NEUTRAL:
                epsilon = 1000
            elif self.state == OVERDRIVE and m >= 2:
                epsilon = 0
            motors.append(0 if self.braked else self.motor(epsilon))
        if self.state != NEUTRAL and not self.braked:
            for c in (1, 2):
                ma = min(605, trunc(shares[c][0] * 410 / 1000) + 195)
                pump[c][0 if self.state == REVERSE else 1] = ma if ma >= 197 else 0
        for c in (1, 2):
            for side, ma in zip("AB", pump[c]):
                said["DriveCurrent", f"Pump{c}{side}"] = ma // 3 * 3
        for m, ma in enumerate(motors):
            said["MotorCurrent", f"Motor{m + 1}"] = ma // 3 * 3
        words = [shares[1][0], shares[2][0], demand[1], demand[2]] if self.regulating else [0] * 4
        for name, word in zip(("Pump1", "Pump2", "Demand1", "Demand2"), words):
            said["DriveDebug5", name] = word

    @staticmethod
    def motor(epsilon):
        """650 mA less half the displacement, in an unsigned word (4.4)."""
        ma = min(650, (650 - quotient(epsilon, 2)) % 65536)
        return ma if ma >= 155 else 0

    def steering(self, joint, mean, said):
        """Section 4.6, chair to the front."""
        j = 0
        if self.steer > 2684:
            j = min(1000, quotient((self.steer - 2684) * 1000, 4230 - 2684))
        elif 0 < self.steer < 2284:
            j = max(-1000, quotient((self.steer - 2284) * 1000, 2284 - 466))

        def rate(full):
            above = abs(j) * (full - 415) // 1000
            current = 415 + above if above else 0
            return [current, 0] if j < 0 else [0, current]

        if self.turn == 1:
            self.front, self.rear = rate(730), [0, 0]
        elif self.turn == 4:
            self.front, self.rear = [0, 0], rate(730)
        elif self.turn == 16:
            self.front, self.rear = rate(730), rate(500)
        else:
            follows = self.follow(joint[0] - joint[1], mean)
            if self.state == REVERSE:
                self.rear = rate(730)
                self.front = follows[::-1] if follows else self.front
            else:
                self.front = rate(730)
                self.rear = follows or self.rear
        for name, currents in (("Front", self.front), ("Rear", self.rear)):
            for side, ma in zip("AB", currents):
                said["DriveCurrent", f"Steer{name}{side}"] = ma // 3 * 3

    def follow(self, e, mean):
        """Currents A and B, or nothing where they are not rewritten (4.6)."""
        self.e_sum = self.e_sum + 0.01 * e if abs(e) > 10 else 0.0
        if self.side is None:
            self.e_sum = 0.0
            if abs(e) > 50:
                self.side = "A" if e > 0 else "B"
            return None
        if (e > 0) != (self.side == "A"):
            self.side = None
            return None
        p = trunc(0.40 * e * min(1, mean // 50))
        i = trunc(0.05 * self.e_sum)
        if abs(i) > 500:
            self.e_sum = 10000.0 if i > 0 else -10000.0
            i = 500 if i > 0 else -500
        above = (p + i if self.side == "A" else -p - i) * 85 // 1000
        current = 415 + above if above > 0 else 0
        return [current, 0] if self.side == "A" else [0, current]

    def show(self, joint, pressure, counts, mean, said):
        """Sections 2.5 and 2.6."""
        for name, p in zip(PUMPS, pressure):
            said["PumpPressure", name] = p / 100
        for n in range(1, 5):
            said["WheelSpeed", f"Wheel{n}"] = counts[0] / 100
        said["WheelSpeedJoint", "Wheel5"] = counts[4] / 100
        said["WheelSpeedJoint", "Wheel6"] = counts[5] / 100
        said["WheelSpeedJoint", "FrontJoint"] = joint[0] / 100
        said["WheelSpeedJoint", "RearJoint"] = joint[1] / 100
        status = {
            "ParkingBrake": 4 if self.braked else 0,
            "TurnMode": self.turn,
            "DriveMode": self.state,
            "Chair": 0,
            "FrontJoint": quotient(joint[0], 50) * 0.5,
            "RearJoint": quotient(joint[1], 50) * 0.5,
            "EngineSpeed": trunc(self.rpm / 10) * 10,
            "Coolant": self.coolant,
        }
        service = {
            "Door": 1,
            "FuelSender": 99,
            "TankOil": 40,
            "FuelLevel": 50,
            "SpeedLimit": self.limit // 10,
            "Speed": trunc(mean * 0.1 * 2 * pi / 60 * 0.74) / 10,
        }
        said.update({("MachineStatus", k): v for k, v in status.items()})
        said.update({("MachineService", k): v for k, v in service.items()})
        said.update({("DriveDebug8", f"D{n}"): 0 for n in range(1, 5)})
        said["DriveDebug10", "Coolant"] = self.coolant
        said["DriveDebug10", "RunningSum"] = (self.coolant_sum + 32768) % 65536 - 32768
