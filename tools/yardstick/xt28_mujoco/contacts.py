"""`python3 -m xt28_mujoco.contacts`: how MuJoCo's wheels stand on one ground, and what that costs."""

import argparse
import time
from pathlib import Path

import mujoco

from . import terrain
from .machine import WHEELS, Machine
from .manoeuvre import Manoeuvre
from .model import Settings
from .vehicle import Vehicle

RATE_HZ = 500
SETTLE_S = 5
REPEATS = 500


def stand(args: argparse.Namespace) -> Vehicle:
    """The machine at rest on the ground."""
    manoeuvre = Manoeuvre(args.manoeuvres, "settle")
    ground = terrain.read(args.grid) if args.grid else None
    vehicle = Vehicle(Machine(args.machine), Settings(RATE_HZ), ground, manoeuvre.start_stroke_m)
    for _ in range(SETTLE_S * RATE_HZ):
        vehicle.step(manoeuvre.at(-1.0))
    return vehicle


def cost_us(vehicle: Vehicle, part) -> float:
    """Processor time of a part of MuJoCo's step, us."""
    begun = time.thread_time_ns()
    for _ in range(REPEATS):
        part(vehicle.model, vehicle.data)
    return (time.thread_time_ns() - begun) / REPEATS / 1e3


def main() -> None:
    """Prints load, sag, stiffness and contacts of each wheel, then the cost of collision."""
    parser = argparse.ArgumentParser(prog="python3 -m xt28_mujoco.contacts", description=__doc__)
    for name in ("machine", "manoeuvres"):
        parser.add_argument(f"--{name}", type=Path, required=True)
    parser.add_argument("--grid", type=Path, help="level ground as an ASCII grid; a plane without")
    vehicle = stand(parser.parse_args())
    for wheel, (name, load_n, contacts) in enumerate(
        zip(WHEELS, vehicle.ground_force_n, vehicle.contacts(), strict=True)
    ):
        sag_m = vehicle.sag_m(wheel)
        print(
            f"{name}  {load_n / 1e3:5.2f} kN  {sag_m * 1e3:5.2f} mm"
            f"  {load_n / sag_m / 1e6:5.2f} MN/m  {contacts} contacts"
        )
    collision, whole = (cost_us(vehicle, p) for p in (mujoco.mj_collision, mujoco.mj_forward))
    print(f"mj_collision {collision:.1f} us of the {whole:.1f} us of mj_forward")


main()
