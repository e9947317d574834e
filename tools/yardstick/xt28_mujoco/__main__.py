"""`python3 -m xt28_mujoco`: one manoeuvre on MuJoCo; CSV to stdout, its cost to stderr as JSON."""

import argparse
import json
import sys
from pathlib import Path

import numpy as np

from . import terrain
from .machine import WHEELS, Machine
from .manoeuvre import Manoeuvre
from .model import Settings
from .vehicle import Vehicle

COLUMNS = (
    ["t_s", "x_m", "y_m", "z_m", "yaw_rad", "roll_rad", "pitch_rad"]
    + ["joint_front_rad", "joint_rear_rad"]
    + [f"stroke_{wheel}_m" for wheel in WHEELS]
    + [f"wheel_speed_{wheel}_rad_s" for wheel in WHEELS]
    + [f"ground_force_{wheel}_n" for wheel in WHEELS]
)


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(prog="python3 -m xt28_mujoco", description=__doc__)
    parser.add_argument("manoeuvre")
    parser.add_argument("--machine", type=Path, required=True, help="the machine file")
    parser.add_argument("--manoeuvres", type=Path, required=True, help="the manoeuvres' file")
    parser.add_argument("--grid", type=Path, help="heights as an ESRI ASCII grid; level without")
    parser.add_argument("--block", type=Path, help="a ramp's terrain file, instead of --grid")
    parser.add_argument("--start", default="", help="x,y,z,yaw,roll,pitch to start from")
    parser.add_argument("--rate", type=int, default=120, help="steps per second")
    for name in ("integrator", "cone", "solver"):
        parser.add_argument(f"--{name}", default=getattr(Settings, name))
    for name in ("impratio", "impedance", "tyre_share"):
        parser.add_argument(f"--{name.replace('_', '-')}", type=float, default=getattr(Settings, name))
    return parser.parse_args()


def main() -> None:
    """Runs the manoeuvre; a row each sample, ground forces as the mean since the last."""
    args = arguments()
    machine = Machine(args.machine)
    manoeuvre = Manoeuvre(args.manoeuvres, args.manoeuvre)
    settings = Settings(
        rate_hz=args.rate,
        integrator=args.integrator,
        cone=args.cone,
        solver=args.solver,
        impratio=args.impratio,
        impedance=args.impedance,
        tyre_share=args.tyre_share,
    )
    ground = None
    if args.block:
        ground = terrain.read_ramp(args.block)
    elif args.grid:
        ground = terrain.read(args.grid)
    vehicle = Vehicle(machine, settings, ground, manoeuvre.start_stroke_m)
    if args.start:
        vehicle.place(*map(float, args.start.split(",")))
    for step in range(round(manoeuvre.settle_s * args.rate)):
        vehicle.step(manoeuvre.at(-1.0))

    every = round(manoeuvre.sample_s * args.rate)
    vehicle.step_ns = 0
    steps = round(manoeuvre.duration_s * args.rate)
    force_n = np.zeros(len(WHEELS))
    print(",".join(COLUMNS))
    for step in range(steps):
        vehicle.step(manoeuvre.at(step / args.rate))
        force_n += vehicle.ground_force_n / every
        if (step + 1) % every == 0:
            row = [(step + 1) / args.rate, *vehicle.observe(), *force_n.tolist()]
            print(",".join(f"{value:.7g}" for value in row))
            force_n[:] = 0.0
    print(json.dumps({"steps": steps, "step_ns": vehicle.step_ns / steps}), file=sys.stderr)


main()
