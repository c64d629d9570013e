"""The cell that the program exports (cell.xml of a result folder) in the stock engine."""

import os
import subprocess
import time

import mujoco
import numpy as np

from suite import Refused

ARM = [f"arm_joint{i}" for i in range(1, 7)]
PADS = ("pad_left", "pad_right")
FINGERS = ("finger_left", "finger_right")
# One value instead of a range, another for each pair, so that every expected value is known; all tubes alike.
ASKED = {"tube_friction": 0.45, "bin_friction": 0.35, "tray_friction": 0.55, "pad_friction": 0.8,
         "pad_torsion_m": 0.001, "mass_scale": 1.0}
ALIKE = ("mass", "radius", "length", "stiffness", "friction", "loss")


def straight_part(lab, **changes):
    """A straight rigid tube of pvc_a's size."""
    length = changes.get("length_m", 0.5)
    return lab.part("pvc_a", name="straight", shape="fixed",
                    centerline_m=[-0.5 * length, 0.0, 0.0, 0.5 * length, 0.0, 0.0], **changes)


def export(lab, part_path, lines):
    """XML of the cell with tubes of a part along lines in the bin, settled by the program. The round that it
    belongs to is ended as soon as the file is there."""
    key = (part_path, str(lines))
    if key in lab.cells:
        return lab.changed(lab.cells[key])
    out = os.path.join(lab.folder, f"cell_{len(lab.cells)}")
    pile = out + ".csv"
    with open(pile, "w") as file:
        file.write("tube,index,x,y,z\n")
        for tube, line in enumerate(lines):
            file.writelines(f"{tube},{i},{p[0]:.9g},{p[1]:.9g},{p[2]:.9g}\n" for i, p in enumerate(line))
    sets = [f"physics.{name}=[{value}, {value}]" for name, value in ASKED.items()]
    sets += [f"physics.specimen.{name}=0" for name in ALIKE]
    sets += [f"pile.file={pile}", f"pile.part={part_path}"]
    command = [os.path.join(lab.programs, "tubetwin"), "run", "--seed", "1", "--out", out, "--force"]
    log = open(out + ".log", "w+")
    round_ = subprocess.Popen(command + [a for s in sets for a in ("--set", s)], stdout=log, stderr=log)
    end, path = time.monotonic() + 120, os.path.join(out, "cell.xml")
    while not os.path.exists(path) and round_.poll() is None and time.monotonic() < end:
        time.sleep(0.02)
    round_.kill()
    round_.wait()
    if not os.path.exists(path):
        log.seek(0)
        raise Refused(f"tubetwin run wrote no cell.xml: {log.read()[-400:]}")
    with open(path) as file:
        lab.cells[key] = file.read()
    return lab.changed(lab.cells[key])


def tube_joint(name):
    return name + "_free"


class Cell:
    """A compiled cell at its start, arm and bin where they are. The arm is held by springs far stiffer than its
    motors: what drives it is not looked at here."""

    def __init__(self, xml, hold_arm=True):
        self.model = m = mujoco.MjModel.from_xml_string(xml)
        self.data = d = mujoco.MjData(m)
        mujoco.mj_resetDataKeyframe(m, d, 0)
        if hold_arm:
            for name in ARM:
                joint = m.joint(name).id
                set_stiffness(m, joint, 1e7)
                m.qpos_spring[m.jnt_qposadr[joint]] = d.qpos[m.jnt_qposadr[joint]]
                m.dof_damping[m.jnt_dofadr[joint]] = 1e4
        mujoco.mj_forward(m, d)
        self.tubes = sorted({m.body(i).name for i in range(m.nbody) if m.body(i).name.startswith("tube")})

    def place(self, tube, p, R):
        """Puts a rigid tube (its middle, its frame's axes) somewhere, at rest."""
        address = self.model.joint(tube_joint(tube)).qposadr[0]
        self.data.qpos[address:address + 3] = p
        quat = np.zeros(4)
        mujoco.mju_mat2Quat(quat, np.asarray(R, float).ravel())
        self.data.qpos[address + 3:address + 7] = quat
        dof = self.model.joint(tube_joint(tube)).dofadr[0]
        self.data.qvel[dof:dof + 6] = 0
        mujoco.mj_forward(self.model, self.data)

    def along(self, tube):
        """Direction of a straight tube in its body's frame."""
        geom = next(g for g in range(self.model.ngeom) if self.model.geom_bodyid[g] == self.model.body(tube).id)
        R = np.zeros(9)
        mujoco.mju_quat2Mat(R, self.model.geom_quat[geom])
        return R.reshape(3, 3)[:, 2]

    def step(self, seconds, each=None):
        for _ in range(int(round(seconds / self.model.opt.timestep))):
            if each:
                each()
            mujoco.mj_step(self.model, self.data)
        mujoco.mj_forward(self.model, self.data)

    def awake(self):
        self.model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)

    def contacts(self, wanted):
        """(contact, names, force on its second geom in the world) of contacts that `wanted` lets through by both names."""
        out, force = [], np.zeros(6)
        for i in range(self.data.ncon):
            contact = self.data.contact[i]
            names = [self.model.geom(g).name for g in contact.geom]
            if wanted(*names):
                mujoco.mj_contactForce(self.model, self.data, i, force)
                out.append((contact, names, contact.frame.reshape(3, 3).T @ force[:3]))
        return out


def set_stiffness(model, joint, value):
    """The engine's stiffness may be a polynomial: its first number is the linear one."""
    if model.jnt_stiffness.ndim > 1:
        model.jnt_stiffness[joint] = 0
        model.jnt_stiffness[joint][0] = value
    else:
        model.jnt_stiffness[joint] = value


def axes_with(x):
    """A rotation whose first column is x."""
    x = np.asarray(x) / np.linalg.norm(x)
    other = np.array([0, 0, 1.0]) if abs(x[2]) < 0.9 else np.array([0, 1.0, 0])
    y = np.cross(other, x)
    y /= np.linalg.norm(y)
    return np.column_stack([x, y, np.cross(x, y)])
