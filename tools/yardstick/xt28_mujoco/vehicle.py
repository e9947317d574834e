"""The machine on MuJoCo, advanced step by step: laws in, `mj_step`, observations out."""

import math
import time

import mujoco
import numpy as np

from .laws import ArmLocks, Drive, JointLocks, rolling_drag_nm
from .machine import REFERENCE_STROKE_M, WHEELS, Machine
from .manoeuvre import Actuation
from .model import Settings, build
from .terrain import Block, Grid


class Vehicle:
    """The nominal machine with its front axle at the origin, heading east."""

    def __init__(
        self,
        machine: Machine,
        settings: Settings,
        ground: Grid | Block | None,
        stroke_m: float,
    ):
        self._machine = machine
        self.model = build(machine, settings, ground)
        self.data = mujoco.MjData(self.model)
        self._arms = ArmLocks(machine, stroke_m)
        self._joints = JointLocks(machine)
        self._drive = Drive(machine)
        self._index()
        self._extend(stroke_m)
        self.ground_force_n = np.zeros(len(WHEELS))
        self.step_ns = 0

    def _index(self) -> None:
        model = self.model
        hinges = {
            kind: [model.joint(f"{kind}_{name}").id for name in names]
            for kind, names in (("arm", WHEELS), ("wheel", WHEELS), ("joint", (1, 2)))
        }
        self._hinge = {kind: np.array(ids) for kind, ids in hinges.items()}
        self._at = {kind: model.jnt_qposadr[ids] for kind, ids in self._hinge.items()}
        self._dof = {kind: model.jnt_dofadr[ids] for kind, ids in self._hinge.items()}
        self._wheel_bodies = [model.body(f"wheel_{wheel}").id for wheel in WHEELS]
        geoms = [model.geom(f"wheel_{wheel}").id for wheel in WHEELS]
        self._wheel_of_geom = {geom: index for index, geom in enumerate(geoms)}
        self._front = model.body("front").id
        stiffness_at, damping_at = self._hinge["joint"], self._dof["joint"]
        model.jnt_stiffness[stiffness_at] = self._joints.stiffness_nm
        model.dof_damping[damping_at] = self._joints.damping_nms

    def _extend(self, stroke_m: float) -> None:
        """Arms at their stroke, all wheels just touching level ground."""
        linkage = self._machine.linkage
        reference = linkage.angle_rad(REFERENCE_STROKE_M)
        angle = linkage.angle_rad(stroke_m)
        self.data.qpos[self._at["arm"]] = angle - reference
        self.data.qpos[2] = linkage.drop_m(angle) - linkage.drop_m(reference)
        mujoco.mj_forward(self.model, self.data)

    def place(self, x: float, y: float, z: float, yaw: float, roll: float, pitch: float) -> None:
        """Moves the whole machine; angles are the bench's: right side high, nose up > 0."""
        turns = [np.empty(4) for _ in range(3)]
        for turn, axis, angle in zip(turns, np.eye(3), (-roll, -pitch, yaw), strict=True):
            mujoco.mju_axisAngle2Quat(turn, axis, angle)
        whole = turns[2]
        for turn in (turns[1], turns[0]):
            mujoco.mju_mulQuat(whole, whole.copy(), turn)
        self.data.qpos[:7] = (x, y, z, *whole)

    def step(self, actuation: Actuation) -> None:
        """One time step under constant actuation."""
        dt_s = self.model.opt.timestep
        self._move_arms(actuation, dt_s)
        self._turn_joints(actuation, dt_s)
        self._turn_wheels(actuation, dt_s)
        begun = time.thread_time_ns()
        mujoco.mj_step(self.model, self.data)
        self.step_ns += time.thread_time_ns() - begun
        self.ground_force_n = self._ground_force_n()

    def _move_arms(self, actuation: Actuation, dt_s: float) -> None:
        model, angles = self.model, self.data.qpos[self._at["arm"]]
        rates = self.data.qvel[self._dof["arm"]]
        for wheel, (angle, rate) in enumerate(zip(angles, rates, strict=True)):
            stiffness, damping, rest = self._arms.step(
                wheel, actuation.arm_opening[wheel], float(angle), float(rate), dt_s
            )
            model.jnt_stiffness[self._hinge["arm"][wheel]] = stiffness
            model.dof_damping[self._dof["arm"][wheel]] = damping
            model.qpos_spring[self._at["arm"][wheel]] = rest

    def _turn_joints(self, actuation: Actuation, dt_s: float) -> None:
        for joint, (at, dof) in enumerate(zip(self._at["joint"], self._dof["joint"], strict=True)):
            angle, rate = float(self.data.qpos[at]), float(self.data.qvel[dof])
            opening = actuation.steer_opening[joint]
            self.model.qpos_spring[at] = self._joints.step(joint, opening, angle, rate, dt_s)

    def _turn_wheels(self, actuation: Actuation, dt_s: float) -> None:
        data, dofs = self.data, self._dof["wheel"]
        rates = data.qvel[dofs]
        # Along the hinge: the reaction is on the arm.
        data.qfrc_applied[dofs] = self._drive.step(
            actuation.pump, actuation.motor, actuation.engine_rpm, rates, dt_s
        )
        for wheel, dof in enumerate(dofs):
            data.qfrc_applied[dof] += rolling_drag_nm(
                self._machine, self.ground_force_n[wheel], float(rates[wheel])
            )

    def contacts(self) -> list[int]:
        """Number of contacts of each wheel."""
        found = [self._wheel(contact)[0] for contact in self.data.contact]
        return [found.count(wheel) for wheel in range(len(WHEELS))]

    def sag_m(self, wheel: int) -> float:
        """How far a wheel is pressed into level ground at height zero."""
        return self._machine.wheels.radius_m - self.data.xpos[self._wheel_bodies[wheel]][2]

    def _wheel(self, contact) -> tuple[int, float]:
        """The wheel of a contact, and +1 where the contact's normal points at it."""
        wheel = self._wheel_of_geom.get(int(contact.geom[1]))
        if wheel is not None:
            return wheel, 1.0
        return self._wheel_of_geom[int(contact.geom[0])], -1.0

    def _ground_force_n(self) -> np.ndarray:
        """Vertical part of the normal forces of the step just taken."""
        force, wrench = np.zeros(len(WHEELS)), np.zeros(6)
        for index, contact in enumerate(self.data.contact):
            wheel, up = self._wheel(contact)
            mujoco.mj_contactForce(self.model, self.data, index, wrench)
            force[wheel] += up * contact.frame[2] * wrench[0]
        return force

    def observe(self) -> list[float]:
        """Position, yaw, roll, pitch, joints, strokes, wheel speeds, in the order of `COLUMNS`."""
        turn = np.empty(9)
        # Of the joint coordinates, not of xmat: that one is from before the step.
        mujoco.mju_quat2Mat(turn, self.data.qpos[3:7])
        x, y, z = turn.reshape(3, 3).T
        strokes = [self._arms.stroke_m(float(a)) for a in self.data.qpos[self._at["arm"]]]
        return [
            *self.data.qpos[:3].tolist(),
            math.atan2(x[1], x[0]),
            -math.atan2(y[2], z[2]),
            math.asin(x[2]),
            *self.data.qpos[self._at["joint"]].tolist(),
            *strokes,
            *self.data.qvel[self._dof["wheel"]].tolist(),
        ]
