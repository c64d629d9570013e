"""The exported gripper: what it holds by friction, what the wrist weighs, how much room it takes."""

import os
import tomllib

import mujoco
import numpy as np

import cell
from suite import Check, GRAVITY, SOURCE

GRIP_N = 60.0
SLIP_M, TURN_RAD = 0.001, np.radians(1.5)  # Creep stays below until it gives way, which it does within a tenth of a second.


def gripper_file():
    with open(os.path.join(SOURCE, "models", "grippers", "robotiq_2f85.toml"), "rb") as file:
        return tomllib.load(file)


class Held(cell.Cell):
    """A straight tube between the pads, held where its middle is `off` metres beside them, no gravity yet."""

    def __init__(self, lab, off=0.0):
        part, path = cell.straight_part(lab)
        super().__init__(cell.export(lab, path, [[(-0.25, 0.1, 0.013), (0.25, 0.1, 0.013)]]))
        self.gravity = self.model.opt.gravity.copy()
        self.model.opt.gravity[:] = 0
        self.tube, self.part = self.tubes[0], part
        self.awake()
        self.stroke = gripper_file()["stroke_m"]
        self.drive(self.stroke - 2 * part["radius_m"] - 0.001, GRIP_N)  # Just open.
        self.step(0.8)
        R = self.data.site("wrist").xmat.reshape(3, 3)
        self.x, self.y, self.z = R.T
        middle = 0.5 * sum(self.data.geom(p).xpos for p in cell.PADS)
        along = cell.axes_with(self.along(self.tube))
        self.place(self.tube, middle + off * self.x, cell.axes_with(self.x) @ along.T)
        self.drive(self.stroke, GRIP_N)
        self.step(0.8)

    def drive(self, travel_m, force_N):
        grip = self.model.actuator("grip").id
        self.data.ctrl[grip] = travel_m
        self.model.actuator_forcerange[grip] = [-force_N, force_N]

    def body(self):
        return self.model.body(self.tube).id

    def pads(self):
        return 0.5 * sum(self.data.geom(p).xpos for p in cell.PADS)

    def normal_N(self, pads):
        """Sum of forces between pads and tube along the closing direction."""
        total = 0.0
        for pad in pads:  # One shape or several, all named after it.
            met = self.contacts(lambda a, b: a.startswith(pad) or b.startswith(pad))
            total += abs(sum(force @ self.y for _, _, force in met))
        return total

    def ramp(self, force=(0, 0, 0), torque=(0, 0, 0), seconds=3.0):
        """Raises a load on the tube's middle until it gives way. Returns the share of it reached, and the sum of both
        pads' forces on the tube just before (the linkage may tighten or loosen with the load)."""
        start = self.data.xpos[self.body()] - self.pads()
        R0 = self.data.xmat[self.body()].reshape(3, 3).copy()
        steps, normal = int(seconds / self.model.opt.timestep), np.nan
        for i in range(steps):
            self.data.xfrc_applied[self.body(), :3] = np.asarray(force) * i / steps
            self.data.xfrc_applied[self.body(), 3:] = np.asarray(torque) * i / steps
            mujoco.mj_step(self.model, self.data)
            moved = np.linalg.norm(self.data.xpos[self.body()] - self.pads() - start)
            turned = np.arccos(np.clip(0.5 * (np.trace(self.data.xmat[self.body()].reshape(3, 3) @ R0.T) - 1), -1, 1))
            if moved > SLIP_M or turned > TURN_RAD:
                return i / steps, normal
            if i % 10 == 0 and moved < 0.1 * SLIP_M and turned < 0.1 * TURN_RAD:
                normal = self.normal_N(cell.PADS)
        return np.inf, normal


def slip(lab):
    mu, width = cell.ASKED["pad_friction"], gripper_file()["pad_width_m"]
    world = Held(lab)
    yield Check("force of each pad on the tube", GRIP_N, world.normal_N(cell.PADS[:1]), 0.02, "rests of motion",
                "the force asked for", "N")
    load = 3.2 * mu * GRIP_N
    for name, axis in (("along the tube", world.x), ("out of the tool", world.z)):
        share, normal = Held(lab).ramp(force=load * axis)
        yield Check(f"held tube slips {name}: force over both pads'", mu, load * share / normal, 0.05,
                    "a slip of 1 mm while the load rises", "Coulomb; physics.pad_friction as asked")
    load = 5 * mu * GRIP_N * width / 4
    share, normal = Held(lab).ramp(torque=load * world.y)
    yield Check("held tube turns between the pads: torque at 60 N", mu * GRIP_N * width / 2,
                load * share * 2 * GRIP_N / normal, 0.10, "1.5 degrees while the load rises",
                "line contact of evenly spread pressure: mu N a / 2 a pad, a half the pad's width", "N m")


def wrench(lab, off=0.08):
    """Force and torque at the wrist with a tube held beside its middle, less those without it."""
    readings = []
    for with_tube in (True, False):
        world = Held(lab, off)
        world.model.opt.gravity[:] = world.gravity
        if not with_tube:
            world.place(world.tube, [0.6, 1.5, 0.5], np.eye(3))
            world.model.body_gravcomp[world.body()] = 1
            world.model.opt.gravity[:] = world.gravity
            world.drive(world.stroke - 2 * world.part["radius_m"], GRIP_N)
        world.step(1.0)
        readings.append((world.data.sensor("wrist_force").data.copy(), world.data.sensor("wrist_torque").data.copy(),
                         world.data.xipos[world.body()].copy(), world.data.site("wrist").xpos.copy(),
                         world.data.site("wrist").xmat.reshape(3, 3).copy()))
    (F, T, p, site, R), (F0, T0, *_rest) = readings
    weight = world.part["mass_kg"] * GRAVITY
    up = np.array([0, 0, weight])  # What the tool must bear.
    expected_T = R.T @ np.cross(p - site, up)
    source = "statics: m g, and its lever from the tube's centre of mass to the sensor"
    yield Check("weight of a held tube at the wrist", weight, np.linalg.norm(F - F0), 0.01, "rests of motion", source,
                "N")
    yield Check("direction of that weight", 1.0, (F - F0) @ (R.T @ up) / weight**2, 0.01, "the same", source)
    yield Check("torque of a tube held 80 mm beside its middle", 1e3 * np.linalg.norm(expected_T),
                1e3 * np.linalg.norm(T - T0), 0.02, "the tube sags a little between the pads", source, "N mm")
    yield Check("error of that torque's direction", 0.0, 1e3 * np.linalg.norm(T - T0 - expected_T),
                0.03 * 1e3 * np.linalg.norm(expected_T), "the same", source, "N mm", absolute=True)
