"""What is true of one machine: its numbers, and what is wrong with it. Neutral as it comes."""

from dataclasses import dataclass, field

import numpy as np

from xt28_mujoco.machine import WHEELS

N = len(WHEELS)


def each(value: float) -> np.ndarray:
    """A number for every wheel."""
    return np.full(N, float(value))


def per_wheel(value: float):
    """A field that has a number for every wheel."""
    return field(default_factory=lambda: each(value))


@dataclass
class Arms:
    """Valve, oil and cylinder of every arm."""

    delay_s: np.ndarray = per_wheel(0.0)
    lag_s: np.ndarray = per_wheel(0.0)
    play: np.ndarray = per_wheel(0.0)
    deadband: np.ndarray = per_wheel(0.0)
    extension: np.ndarray = per_wheel(1.0)
    contraction: np.ndarray = per_wheel(1.0)
    # Share of the speed that 100 kN on the cylinder takes or gives.
    load_share: np.ndarray = per_wheel(0.0)
    # At 50 kN, in proportion to the load.
    leak_m_s: np.ndarray = per_wheel(0.0)
    sag_m_s: np.ndarray = per_wheel(0.0)
    sag_below_n: float = 6e3
    coulomb_n: np.ndarray = per_wheel(0.0)
    breakaway_n: np.ndarray = per_wheel(0.0)
    stiffness_n_m: np.ndarray = per_wheel(2.0e6)
    damping_n_s_m: np.ndarray = per_wheel(8.5e4)
    # Precharge of a gas spring, Pa, its volume and exponent; none where the precharge is zero.
    precharge_pa: np.ndarray = per_wheel(0.0)
    volume_m3: float = 1.2e-3
    exponent: float = 1.3
    pump_m3_s: float = np.inf
    kp: np.ndarray = per_wheel(1.0)
    ki: np.ndarray = per_wheel(1.0)
    ecu_dead_mm: float = 0.0
    # How fast the ECU's own target follows the one that it is sent.
    target_mm_s: float = np.inf
    fade: float = 0.0
    # A spool that sticks stays where it is until it is asked for this much more or less.
    stick: np.ndarray = per_wheel(0.0)
    # Longest stroke that anything in the way leaves.
    stop_m: np.ndarray = per_wheel(np.inf)


@dataclass
class Steering:
    """Both articulation joints."""

    delay_s: float = 0.0
    lag_s: float = 0.0
    play_deg: float = 0.0
    rate: float = 1.0
    right_rate: float = 1.0
    kp: float = 1.0
    ki: float = 1.0
    rear_lag_s: float = 0.0
    rear_ratio: float = 0.56
    rear_offset_deg: float = 0.0


@dataclass
class Drive:
    """From the throttle to the ground."""

    delay_s: float = 0.0
    lag_s: float = 0.15
    curve: float = 1.0
    rolling: np.ndarray = per_wheel(0.02)
    # Whether that acts between wheel and arm, as in a bearing, for between wheel and ground.
    in_bearings: bool = False
    hold_nm: np.ndarray = per_wheel(0.0)
    flat_nm: np.ndarray = per_wheel(0.0)
    droop_per_w: float = 0.0
    power_w: float = 150e3
    # Share of its torque that the second circuit's worn pump still makes.
    second_circuit: float = 1.0
    # Share by which the engine's speed sways.
    surge: float = 0.0


@dataclass
class Ground:
    """Tyres and what they stand on."""

    stiffness_n_m: np.ndarray = per_wheel(8.0e6)
    damping_n_s_m: np.ndarray = per_wheel(6.0e4)
    friction: np.ndarray = per_wheel(0.7)
    # How much stiffer friction is than the tyre below the cone.
    impratio: float = 2.25
    slope_along: float = 0.0
    slope_across: float = 0.0


@dataclass
class Masses:
    """What is not as the machine file says."""

    share: np.ndarray = field(default_factory=lambda: np.ones(3))
    payload_kg: float = 0.0
    payload_ahead_m: float = -5.6
    payload_left_m: float = 0.0
    payload_up_m: float = 1.7
    front_com_ahead_m: float = 0.0
    front_com_left_m: float = 0.0


@dataclass
class Sensors:
    """What the readings are off by, and their noise."""

    stroke_bias_mm: np.ndarray = per_wheel(0.0)
    stroke_scale: np.ndarray = per_wheel(1.0)
    # Play of what moves the sensor.
    stroke_play_mm: np.ndarray = per_wheel(0.0)
    pressure_bias_kpa: np.ndarray = per_wheel(0.0)
    pressure_scale: np.ndarray = per_wheel(1.0)
    pressure_lag_s: float = 0.0
    imu_roll_deg: float = 0.0
    imu_pitch_deg: float = 0.0
    imu_keep_roll: float = 0.995
    imu_keep_pitch: float = 0.99
    wheel_scale: np.ndarray = per_wheel(1.0)
    wheel_lag_s: float = 0.0
    gnss_late_s: float = 0.0
    heading_bias_deg: float = 0.0
    antenna_ahead_m: float = 0.0
    antenna_left_m: float = 0.0
    wander_m: float = 0.0
    joint_lag_s: float = 0.0
    joint_bias_deg: float = 0.0
    joint_scale: float = 1.0
    noise: float = 1.0


@dataclass
class Bus:
    """What happens to the commands."""

    loss: float = 0.0
    late_s: float = 0.0


@dataclass
class Truth:
    """All of it."""

    arms: Arms = field(default_factory=Arms)
    steering: Steering = field(default_factory=Steering)
    drive: Drive = field(default_factory=Drive)
    ground: Ground = field(default_factory=Ground)
    masses: Masses = field(default_factory=Masses)
    sensors: Sensors = field(default_factory=Sensors)
    bus: Bus = field(default_factory=Bus)


def tolerances(truth: Truth, random: np.random.Generator) -> None:
    """Draws what no two sound machines have in common."""

    def about(share: float, count=N) -> np.ndarray:
        return 1.0 + share * random.uniform(-1.0, 1.0, count)

    truth.masses.share = about(0.03, 3)
    truth.arms.stiffness_n_m *= about(0.05, 1)[0]
    truth.arms.damping_n_s_m *= about(0.05, 1)[0]
    truth.ground.friction *= about(0.05, 1)[0]
    truth.drive.rolling *= about(0.05, 1)[0]
    truth.arms.extension *= about(0.01)
    truth.arms.contraction *= about(0.01)
