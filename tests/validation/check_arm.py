"""Arm of the exported cell against pinocchio, whose model is built from the arm file alone."""

import os
import tomllib

import mujoco
import numpy as np

import cell
from suite import GRAVITY, SOURCE, Check, Refused, edit

try:
    import pinocchio
except ImportError:
    pinocchio = None

CONFIGURATIONS = 50
RESULT = "pinocchio, from models/arms/hc10.toml alone"


def read(*path):
    with open(os.path.join(SOURCE, "models", *path), "rb") as file:
        return tomllib.load(file)


def rotation(rpy_deg):
    """Fixed axes x, y, z in turn, as a URDF's."""
    r, p, y = np.radians(rpy_deg)
    Rx = np.array([[1, 0, 0], [0, np.cos(r), -np.sin(r)], [0, np.sin(r), np.cos(r)]])
    Ry = np.array([[np.cos(p), 0, np.sin(p)], [0, 1, 0], [-np.sin(p), 0, np.cos(p)]])
    Rz = np.array([[np.cos(y), -np.sin(y), 0], [np.sin(y), np.cos(y), 0], [0, 0, 1]])
    return Rz @ Ry @ Rx


def arm_model(arm):
    """Pinocchio's model of the arm file: joints, links, no tool."""
    model = pinocchio.Model()
    model.gravity.linear = np.array([0, 0, -GRAVITY])
    parent = 0
    for joint, link in zip(arm["joint"], arm["link"][1:]):
        placement = pinocchio.SE3(np.eye(3), np.array(joint["origin_m"]))
        axis = np.array(joint["axis"], float)
        parent = model.addJoint(parent, pinocchio.JointModelRevoluteUnaligned(axis), placement, joint["name"])
        xx, yy, zz, xy, xz, yz = link["inertia_kgm2"]
        inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        model.appendBodyToJoint(parent, pinocchio.Inertia(link["mass_kg"], np.array(link["centre_m"]), inertia),
                                pinocchio.SE3.Identity())
    model.armature = np.array([j["armature_kgm2"] for j in arm["joint"]])
    return model


def bare_arm(xml):
    """The exported cell with nothing but the arm: no tool, no tubes, no keyframe."""
    def change(root):
        for body in list(root.iter("body")):
            for child in list(body):
                if child.tag == "body" and not child.get("name", "").startswith("arm_link"):
                    body.remove(child)
        world = root.find("worldbody")
        for body in world.findall("body"):
            if body.get("name") != "arm_base":
                world.remove(body)
        for tag in ("tendon", "equality", "actuator", "sensor", "keyframe", "contact"):
            for section in root.findall(tag):
                root.remove(section)
    return mujoco.MjModel.from_xml_string(edit(xml, change))


def kinematics_and_dynamics(lab):
    if pinocchio is None:
        raise Refused("pinocchio is not installed")
    arm, tool = read("arms", "hc10.toml"), read("cells", "leao2020.toml")["tool"]
    model = arm_model(arm)
    data = model.createData()
    _, path = cell.straight_part(lab)
    xml = cell.export(lab, path, [[(-0.25, 0.1, 0.013), (0.25, 0.1, 0.013)]])
    whole, bare = mujoco.MjModel.from_xml_string(xml), bare_arm(xml)
    wd, bd = mujoco.MjData(whole), mujoco.MjData(bare)
    flange = pinocchio.SE3(rotation(arm["flange_rpy_deg"]), np.array(arm["flange_origin_m"]))
    # The sensor's tool face: x y z, quaternion w x y z.
    face = pinocchio.SE3(pinocchio.Quaternion(*tool["X_FK"][3:]).toRotationMatrix(), np.array(tool["X_FK"][:3]))
    rng = np.random.default_rng(1)
    errors = {"place": 0.0, "turn": 0.0, "mass": 0.0, "bias": 0.0, "inverse": 0.0}
    for _ in range(CONFIGURATIONS):
        low, high = np.radians(np.array([j["range_deg"] for j in arm["joint"]])).T
        q, v, a = rng.uniform(low, high), rng.uniform(-2, 2, 6), rng.uniform(-5, 5, 6)
        pinocchio.framesForwardKinematics(model, data, q)
        X = data.oMi[6] * flange * face
        for name, angle in zip(cell.ARM, q):
            wd.qpos[whole.joint(name).qposadr[0]] = angle
        mujoco.mj_kinematics(whole, wd)
        errors["place"] = max(errors["place"], np.linalg.norm(wd.site("wrist").xpos - X.translation))
        turn = wd.site("wrist").xmat.reshape(3, 3) @ X.rotation.T
        errors["turn"] = max(errors["turn"], np.linalg.norm(turn - np.eye(3)))
        bd.qpos[:], bd.qvel[:] = q, v
        mujoco.mj_forward(bare, bd)
        M = np.zeros((6, 6))
        mujoco.mj_fullM(bare, bd, M)
        Mp = pinocchio.crba(model, data, q)
        Mp = np.triu(Mp) + np.triu(Mp, 1).T
        bias = pinocchio.rnea(model, data, q, v, np.zeros(6))
        tau = pinocchio.rnea(model, data, q, v, a)
        errors["mass"] = max(errors["mass"], np.abs(M - Mp).max() / np.abs(Mp).max())
        errors["bias"] = max(errors["bias"], np.abs(bd.qfrc_bias - bias).max())
        errors["inverse"] = max(errors["inverse"], np.abs(M @ a + bd.qfrc_bias - tau).max())
    digits = "the model file has six digits"
    many = f"{CONFIGURATIONS} random configurations: largest error of "
    yield Check(many + "the tool face's place", 0.01, 1e3 * errors["place"], 0, digits, RESULT, "mm", kind="most")
    yield Check(many + "the tool face's rotation matrix", 1e-5, errors["turn"], 0, digits, RESULT, kind="most")
    yield Check(many + "the mass matrix, share", 1e-4, errors["mass"], 0, digits, RESULT, kind="most")
    yield Check(many + "gravity and velocity forces", 0.02, errors["bias"], 0, digits, RESULT, "N m", kind="most")
    yield Check(many + "inverse dynamics", 0.02, errors["inverse"], 0, digits, RESULT, "N m", kind="most")



def tools(lab):
    """Masses on the flange, which the force sensor tells apart: above it scanner and sensor, below it the gripper."""
    _, path = cell.straight_part(lab)
    model = mujoco.MjModel.from_xml_string(cell.export(lab, path, [[(-0.25, 0.1, 0.013), (0.25, 0.1, 0.013)]]))
    gripper = read("grippers", "robotiq_2f85.toml")
    for name, expected, source in (
            ("gripper", gripper["mass_kg"] + gripper["coupling_mass_kg"], "models/grippers/robotiq_2f85.toml"),
            ("scanner", read("scanners", "phoxi_s.toml")["mass_kg"], "models/scanners/phoxi_s.toml"),
            ("wrist sensor", read("wrists", "ati_gamma_si65.toml")["mass_kg"], "models/wrists/ati_gamma_si65.toml")):
        body = model.body({"gripper": "tool"}.get(name, name.replace(" ", "_"))).id
        yield Check(f"mass of the {name}", expected, model.body_subtreemass[body], 1e-4, "written with six digits",
                    source, "kg")
