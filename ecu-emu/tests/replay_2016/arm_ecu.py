"""The arm ECU of 2016, calculated from the published formulas alone: voltages in, signals out.

Shares no line with the emulator. Section numbers are those of the facts about the public firmware.
Lists are in the order FR FL MR ML BR BL.
"""

from math import acos, atan, cos, degrees, exp, floor, pi, sin, trunc

WHEELS = ["FR", "FL", "MR", "ML", "BR", "BL"]
LEFT = [False, True] * 3
AXLE = [0, 0, 1, 1, 2, 2]


def mv(volts):
    """A voltage in whole mV."""
    return floor(volts + 0.5)


class Linkage:
    """Section 1.4."""

    B, R, L = 0.4991, 1.211, 1.008

    def __init__(self, closed):
        self.closed = closed

    def at(self, stroke_mm):
        """Wheel below the pivot, and vertical force per cylinder force."""
        c = self.closed + stroke_mm / 1000
        alpha = acos((self.B**2 + self.R**2 - c**2) / (2 * self.B * self.R))
        theta = 0.3370 + alpha + 0.2983
        drop = -self.L * cos(theta)
        ratio = self.B * self.R * sin(alpha) / (c * self.L * sin(theta))
        return drop, ratio


FORCE, HEIGHT = Linkage(0.82), Linkage(0.85)

PRESETS = {10: (2, 100, 40, 0), 11: (10, 300, 80, 100), 12: (11, 320, 100, 200)}
JOG = {1: "FL", 3: "FR", 4: "ML", 6: "MR", 7: "BL", 9: "BR"}
PITCH_SHARE = [-0.1192, 0.0046, 0.1152]


class ArmEcu:
    """All that the ECU keeps from tick to tick."""

    def __init__(self):
        self.tick = -1
        self.pressure = {(w, c): 0 for w in range(6) for c in "AB"}
        self.stroke, self.rate = None, [0] * 6
        self.theta = self.phi = 0
        self.mode, self.latched, self.down = None, None, False
        self.gains, self.preset = (0, 0, 0, 0), 0
        self.ramp = 0
        self.start = None
        self.offset, self.shown = 0.0, 0
        self.beta = 0.0
        self.awake = [None] * 6
        self.u = [0] * 6
        self.brake_seen = 0
        self.passive = False
        self.pad_age, self.alert = 0, 0
        self.imu_age = 0
        self.buttons, self.x, self.y = set(), 0, 0

    def step(self, volts, imu, pad, status):
        """One tick: voltages by name, IMU words of the tick, pad frames of the tick, last status."""
        self.tick += 1
        if pad:
            self.buttons, self.x, self.y = pad
            self.pad_age = 0
        # The fault task runs every 50 ms, half a tick before (3.1); it looks, then counts (3.9).
        if self.tick % 5 == 1:
            lost = self.pad_age > 180
            self.pad_age += 50
            if lost:
                self.mode = None
            self.alert = int(lost)
        said = {}
        self.attitude(imu, said)
        self.sensors(volts, said)
        self.forces(said)
        self.toggle()
        if self.mode == 18:
            self.brake_seen = status[0]
        self.act(chair_front=status[1] == 1, brake=status[0] == 4)
        self.valves(said)
        self.show(volts, said)
        return said

    def attitude(self, imu, said):
        """Section 5: whole thousandths of a degree."""
        rate_theta, rate_phi, acc_x, acc_y, acc_z = imu
        lean_phi = degrees(atan(acc_x / acc_z)) * 1000
        lean_theta = -degrees(atan(acc_y / acc_z)) * 1000
        turn = 1000 * 0.01 / 50
        self.phi = trunc(0.995 * (self.phi + rate_phi * turn) + 0.005 * lean_phi)
        self.theta = trunc(0.99 * (self.theta + rate_theta * turn) + 0.01 * lean_theta)
        said["Attitude", "Pitch"] = trunc(self.theta / 10) / 100
        said["Attitude", "Roll"] = trunc(self.phi / 10) / 100
        said["GyroCopy", "PitchRate"], said["GyroCopy", "RollRate"] = rate_theta / 50, rate_phi / 50
        for axis, value in zip("XYZ", (acc_x, acc_y, acc_z)):
            said["AccelCopy", axis] = value

    def sensors(self, volts, said):
        """Section 3.2."""
        stroke = [max(0, trunc((mv(volts[f"stroke_{w}"]) - 500) / 4000 * 485)) for w in WHEELS]
        last = self.stroke or stroke
        self.stroke = stroke
        for w in range(6):
            self.rate[w] = trunc(self.rate[w] / 1.1 + 5 / 1.1 * (stroke[w] - last[w]))
            for chamber in "AB":
                raw = trunc(6.25 * mv(volts[f"{chamber.lower()}_{WHEELS[w]}"]) - 3125)
                kept = self.pressure[w, chamber]
                self.pressure[w, chamber] = trunc(0.94088 * kept + (1 - 0.94088) * max(0, raw))
        self.mean = sum(stroke) // 6
        for w, name in enumerate(WHEELS):
            half = "Front" if w < 2 else "MidRear"
            said["Pos" + half, name] = said["DisplayPos" + half, name] = stroke[w]
            said["Vel" + half, name] = 2 * self.rate[w]
            for chamber in "AB":
                axle = ["Front", "Mid", "Rear"][AXLE[w]]
                said["Press" + axle, f"{name}_{chamber}"] = self.pressure[w, chamber]
        said["Attitude", "MeanStroke"] = self.mean
        said["Attitude", "MeanStrokeRate"] = trunc(sum(self.rate) / 6)

    def forces(self, said):
        """Sections 3.3 and 3.4."""
        area = {"A": 0.00785, "B": 0.00589}
        chamber = {at: trunc(100 * kpa * area[at[1]]) for at, kpa in self.pressure.items()}
        self.load = [chamber[w, "A"] - chamber[w, "B"] for w in range(6)]
        ratio = [FORCE.at(mm)[1] for mm in self.stroke]
        wheel = [trunc(k * f) for k, f in zip(ratio, self.load)]
        total = sum(f for f in wheel if f > 0)
        self.reference = [0] * 6
        centre, total_reference = (0, 0), 0
        if total:
            x = 2.35 * sum(f for f, left in zip(wheel, LEFT) if not left) / total
            y = (3.70 * (wheel[2] + wheel[3]) + 6.05 * (wheel[4] + wheel[5])) / total
            omega = pi / 2 * y / 3.70 if y <= 3.70 else pi / 2 * (1 + (y - 3.70) / 2.35)
            k_m = 0.3388 * sin(omega)
            share = [(6.05 - y - 2.35 * k_m) / 6.05, k_m, (y - 3.70 * k_m) / 6.05]
            right = x / 2.35
            vertical = [
                share[AXLE[w]] * (1 - right if LEFT[w] else right) * total for w in range(6)
            ]
            self.reference = [trunc(f / k) for f, k in zip(vertical, ratio)]
            centre = trunc(100 * x / 2.35), trunc(100 * y / 6.05)
            total_reference = trunc(sum(vertical))
        for w, name in enumerate(WHEELS):
            half, axle = "Front" if w < 2 else "MidRear", ["Front", "Mid", "Rear"][AXLE[w]]
            left_first = "FrontMid" if w < 4 else "Rear"
            for c in "AB":
                said["ChamberForce" + axle, f"{name}_{c}"] = chamber[w, c]
            said["CylLoad" + half, name] = self.load[w]
            said["WheelForce" + half, name] = wheel[w]
            said["OptLoad" + left_first, name] = self.reference[w]
            said["ForceErr" + left_first, name] = trunc(-100 * self.error(w))
        said["OptLoadRear", "SumPositive"] = total
        said["OptLoadRear", "SumReference"] = total_reference
        said["CentreOfMass", "Lateral"], said["CentreOfMass", "Longitudinal"] = centre

    def error(self, w):
        """Relative force error, controller's sign (3.5)."""
        reference = self.reference[w]
        return (reference - self.load[w]) / reference if reference else 0.0

    def toggle(self):
        """Section 3.8."""
        down = bool(self.buttons)
        if down and not self.down:
            (button,) = self.buttons
            if not (self.mode == 18 and button in (13, 14)):
                self.mode = None if button == self.latched else button
        if self.down and not down:
            self.latched = self.mode
        self.down = down

    def stick(self, volts):
        """Joystick in mA (3.8)."""
        if volts > 2550:
            return trunc((volts - 2550) * 300 / 1750)
        return trunc((volts - 2150) * 300 / 2200) if volts < 2150 else 0

    def act(self, chair_front, brake):
        """The mode's u (3.5, 3.8)."""
        x, y = self.stick(self.x), self.stick(self.y)
        if self.mode not in (19, 21):
            self.ramp = 0
        if self.mode is None:
            self.u = [0] * 6
        elif self.mode == 18:
            self.level(brake)
        elif self.mode in JOG:
            name = JOG[self.mode]
            if not chair_front:
                name = {"F": "B", "M": "M", "B": "F"}[name[0]] + {"R": "L", "L": "R"}[name[1]]
            self.u = [y if w == name else 0 for w in WHEELS]
        elif self.mode == 16:
            way = 1 if chair_front else -1
            along = [y, 0, -y]
            self.u = [way * ((-x if LEFT[w] else x) + along[AXLE[w]]) for w in range(6)]
        elif self.mode in (19, 21):
            if self.down:
                self.ramp = min(200, self.ramp + 1)
                u = self.ramp * 4 // 10
                self.u = [-u if self.mode == 19 else u] * 6
            else:
                self.mode, self.u = None, [0] * 6
        else:
            if self.mode in PRESETS:
                self.gains, self.preset = PRESETS[self.mode], self.mode - 9
            elif self.mode == 17:
                self.passive = not self.passive
            self.mode = None

    def level(self, brake):
        """Section 3.5."""
        if brake or self.tick < 500:
            self.mode = None
            return
        drop = [HEIGHT.at(mm)[0] for mm in self.stroke]
        front, middle, rear = ((drop[i] + drop[i + 1]) / 2 for i in (0, 2, 4))
        raw = degrees(atan((front - middle) / 3.70) + atan((front - rear) / 6.05)) / 2
        self.beta = 0.995 * self.beta + 0.005 * raw
        if 18 in self.buttons:
            self.start = self.tick, self.mean, self.phi / 1000, self.theta / 1000
            return
        if 13 in self.buttons or 14 in self.buttons:
            self.offset += 0.5 if 14 in self.buttons else -0.5
            self.offset = max(-150.0, min(100.0, self.offset))
        began, height0, phi0, theta0 = self.start
        t = (self.tick - began) * 0.01
        g = 1.0 if t >= 5 else 1 / (1 + exp(-1.9 * (t - 2.5)))
        height = 250 + self.offset
        self.shown = trunc(height)
        phi, theta = self.phi / 1000, self.theta / 1000
        e_z = height0 + (height - height0) * g - self.mean
        e_phi = phi0 + (0 - phi0) * g - phi
        e_theta = theta0 + (theta - self.beta - theta0) * g - theta
        p_z, p_theta, p_phi, p_f = self.gains
        for w in range(6):
            lean = (1 if LEFT[w] else -1) / 3 * p_phi * e_phi
            u = -0.1694 * p_z * e_z + lean + PITCH_SHARE[AXLE[w]] * p_theta * e_theta
            self.u[w] = trunc(u - g * p_f * self.dead_band(w, self.error(w)))

    def dead_band(self, w, error):
        """Asleep until 0.5 %, awake until the sign turns (3.5)."""
        positive = error > 0
        if self.awake[w] is None:
            if abs(error) > 0.005:
                self.awake[w] = positive
            return 0.0
        if self.awake[w] != positive:
            self.awake[w] = None
        return error

    def valves(self, said):
        """Section 3.6; the left comes first where currents are measured."""
        for w, name in enumerate(WHEELS):
            u = max(-400, min(400, self.u[w]))
            a = 400 + u if u > 0 and self.stroke[w] >= 20 else 0
            b = 400 - u if u < 0 and self.stroke[w] <= 460 else 0
            axle = ["Front", "Mid", "Rear"][AXLE[w]]
            for kind in ("RefCurrent", "ActCurrent"):
                said[kind + axle, name + "_A"], said[kind + axle, name + "_B"] = a, b

    def show(self, volts, said):
        """Supplies, debug words and display (2.1, 2.5)."""
        battery = trunc(volts["supply"])
        said["Supply", "Battery"], said["Supply", "Sensor1"] = battery, 5000
        said["Supply", "Sensor3"] = 5000
        said["ArmDebug1", "Preset"], said["ArmDebug1", "D2"] = self.preset, 0
        said["ArmDebug2", "BrakeSeen"], said["ArmDebug2", "D4"] = self.brake_seen, 0
        said["ArmDebug3", "D5"], said["ArmDebug3", "BatteryMv"] = 0, battery
        said["ArmDisplay", "Alert"] = self.alert
        said["ArmDisplay", "HeightReference"] = self.shown
        said["ArmDisplay", "Passive"] = int(self.passive)
        said["ArmDisplay", "Levelling"] = int(self.mode == 18)
