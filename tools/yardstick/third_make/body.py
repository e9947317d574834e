"""The rigid machine on MuJoCo: pushes and torques in, where it is and how it moves out."""

import math

import mujoco
import numpy as np

from xt28_mujoco.machine import REFERENCE_STROKE_M, WHEELS, Machine
from xt28_mujoco.model import Settings, build
from xt28_mujoco.terrain import Block

from .sensing import level_gravity
from .truth import N, Truth

RATE_HZ = 500
# Share of a contact that is constraint: the rest is a mass that no tyre has.
IMPEDANCE = 0.1


class Body:
    """Three frames, six arms, six wheels."""

    def __init__(self, machine: Machine, truth: Truth, ramp: Block | None, stroke_m: list[float]):
        settings = Settings(RATE_HZ, impratio=truth.ground.impratio, impedance=IMPEDANCE)
        self.model = model = build(machine, settings, ramp)
        self._linkage = machine.linkage
        self._reference = machine.linkage.angle_rad(REFERENCE_STROKE_M)
        self._index()
        model.dof_damping[:] = 0.0
        model.jnt_stiffness[:] = 0.0
        self._tyre = machine.vehicle.tyre_stiffness_n_m, machine.vehicle.tyre_damping_n_s_m
        self._own = {
            name: getattr(model, name).copy()
            for name in ("geom_solref", "body_mass", "body_inertia", "body_ipos")
        }
        self.become(truth)
        self.data = mujoco.MjData(model)
        self._stand(stroke_m)

    def become(self, truth: Truth) -> None:
        """The masses, tyres and ground that are true from now on."""
        model, g = self.model, truth.ground
        for name, values in self._own.items():
            getattr(model, name)[:] = values
        self._weigh(truth)
        for geom, w in self._wheel_of.items():
            model.geom_friction[geom, 0] = g.friction[w]
            model.geom_solref[geom] *= (
                g.stiffness_n_m[w] / self._tyre[0],
                g.damping_n_s_m[w] / self._tyre[1],
            )
        model.opt.gravity[:] = level_gravity(g.slope_along, g.slope_across)

    def _index(self) -> None:
        model = self.model
        self._at, self._dof = {}, {}
        for kind, names in (("arm", WHEELS), ("wheel", WHEELS), ("joint", (1, 2))):
            ids = [model.joint(f"{kind}_{name}").id for name in names]
            self._at[kind] = model.jnt_qposadr[ids]
            self._dof[kind] = model.jnt_dofadr[ids]
        self._wheel_bodies = [model.body(f"wheel_{name}").id for name in WHEELS]
        self._wheel_joints = [model.joint(f"wheel_{name}").id for name in WHEELS]
        geoms = [model.geom(f"wheel_{name}").id for name in WHEELS]
        self._wheel_of = {geom: w for w, geom in enumerate(geoms)}
        self._front = model.body("front").id

    def _weigh(self, truth: Truth) -> None:
        """Masses as they are, and what lies in the bunk as a body of its own size."""
        model, m = self.model, truth.masses
        for frame, share in zip(("front", "middle", "rear"), m.share, strict=True):
            body = model.body(frame).id
            model.body_mass[body] *= share
            model.body_inertia[body] *= share
        model.body_ipos[self._front, :2] += (m.front_com_ahead_m, m.front_com_left_m)
        if m.payload_kg > 0.0:
            rear = model.body("rear").id
            own, load = model.body_mass[rear], m.payload_kg
            at = np.array((m.payload_ahead_m, m.payload_left_m, m.payload_up_m))
            at -= model.body_ipos[rear]
            both = own * load / (own + load)
            x, y, z = 4.0, 1.6, 1.0
            box = load / 12.0 * np.array((y * y + z * z, x * x + z * z, x * x + y * y))
            model.body_inertia[rear] += box + both * (at @ at - at * at)
            model.body_ipos[rear] += at * load / (own + load)
            model.body_mass[rear] = own + load
        mujoco.mj_setConst(model, mujoco.MjData(model))

    def _stand(self, stroke_m: list[float]) -> None:
        angles = [self._linkage.angle_rad(s) for s in stroke_m]
        self.data.qpos[self._at["arm"]] = np.array(angles) - self._reference
        drops = [self._linkage.drop_m(a) for a in angles]
        self.data.qpos[2] = max(drops) - self._linkage.drop_m(self._reference)
        mujoco.mj_forward(self.model, self.data)

    def strokes(self) -> tuple[list[float], list[float], list[float]]:
        """Stroke, m; its rate, m/s; lever of the cylinder about the pivot, m."""
        angles = self.data.qpos[self._at["arm"]] + self._reference
        rates = self.data.qvel[self._dof["arm"]]
        levers = [self._linkage.lever_m(a) for a in angles.tolist()]
        strokes = [self._linkage.stroke_m(a) for a in angles.tolist()]
        return strokes, [r * lever for r, lever in zip(rates.tolist(), levers, strict=True)], levers

    def joints(self) -> tuple[list[float], list[float]]:
        """Angles, rad, left > 0, and rates of both joints."""
        return (
            self.data.qpos[self._at["joint"]].tolist(),
            self.data.qvel[self._dof["joint"]].tolist(),
        )

    def wheels(self) -> tuple[list[float], list[float]]:
        """Angles, rad, and rates of the wheels beside their arms."""
        return (
            self.data.qpos[self._at["wheel"]].tolist(),
            self.data.qvel[self._dof["wheel"]].tolist(),
        )

    def step(self, arm_nm, joint_nm, wheel_nm, ground_nm) -> None:
        """One step under these torques; a wheel has one between it and its arm, and one of the ground."""
        data = self.data
        data.qfrc_applied[self._dof["arm"]] = arm_nm
        data.qfrc_applied[self._dof["joint"]] = joint_nm
        data.qfrc_applied[self._dof["wheel"]] = wheel_nm
        data.xfrc_applied[self._wheel_bodies, 3:] = (
            np.array(ground_nm)[:, None] * data.xaxis[self._wheel_joints]
        )
        mujoco.mj_step(self.model, data)

    def normal_n(self) -> list[float]:
        """What the ground pushes each wheel with."""
        push, wrench = [0.0] * N, np.zeros(6)
        for index in range(self.data.ncon):
            pair = self.data.contact.geom[index]
            w = self._wheel_of.get(int(pair[1]), self._wheel_of.get(int(pair[0])))
            mujoco.mj_contactForce(self.model, self.data, index, wrench)
            push[w] += wrench[0]
        return push

    def front(self, at_m) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Turn, place and velocity of a point of the front frame; turning rate in its axes."""
        quat, turn = self.data.qpos[3:7], np.empty(9)
        mujoco.mju_quat2Mat(turn, quat)
        turn = turn.reshape(3, 3)
        rate = self.data.qvel[3:6].copy()
        (a, b, c), (x, y, z) = rate.tolist(), at_m
        round_it = np.array((b * z - c * y, c * x - a * z, a * y - b * x))
        velocity = self.data.qvel[:3] + turn @ round_it
        return turn, self.data.qpos[:3] + turn @ at_m, velocity, rate


def heading(turn: np.ndarray) -> float:
    """Of the front frame, rad from east, counter-clockwise."""
    return math.atan2(turn[1, 0], turn[0, 0])
