"""One tube in the stock engine: held at a link, loaded, let go."""

import mujoco
import numpy as np

from suite import Refused, edit

NAME = "tube0"


def straight(length_m, links, height_m=0.3):
    x = np.linspace(-0.5 * length_m, 0.5 * length_m, links + 1)
    return np.column_stack([x, np.zeros_like(x), np.full_like(x, height_m)])


def clamped(xml):
    """The tube without its free joint: its root link stays where it is."""
    def change(root):
        for body in root.iter("body"):
            for joint in list(body):
                if joint.tag == "freejoint" or joint.get("type") == "free":
                    body.remove(joint)
    return edit(xml, change)


class Rod:
    """A compiled tube. Nodes are those of the centerline that it was made from."""

    def __init__(self, xml, centerline, names=None):
        self.model = mujoco.MjModel.from_xml_string(xml)
        self.model.opt.gravity[:] = 0
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
        self.data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, self.data)
        self.line = np.asarray(centerline)
        names = names or [f"{NAME}_{i}" for i in range(len(centerline) - 1)]
        self.bodies = [self.model.body(name).id for name in names]
        self.root = next(i for i, body in enumerate(self.bodies) if self.model.body_parentid[body] == 0)
        self.local = [self.to_body(self.bodies[min(i, len(self.bodies) - 1)], p) for i, p in enumerate(self.line)]

    def to_body(self, body, p):
        return self.data.xmat[body].reshape(3, 3).T @ (p - self.data.xpos[body])

    def node(self, i):
        body = self.bodies[min(i if i >= 0 else i + len(self.line), len(self.bodies) - 1)]
        return self.data.xpos[body] + self.data.xmat[body].reshape(3, 3) @ self.local[i]

    def nodes(self):
        return np.array([self.node(i) for i in range(len(self.line))])

    def clamp_arc(self):
        """Arc length of the root link's middle: there a continuous rod is held."""
        at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(self.line, axis=0), axis=1))])
        return 0.5 * (at[self.root] + at[self.root + 1])

    def push(self, i, force_N=(0, 0, 0), torque_Nm=(0, 0, 0)):
        """A force on a node, fixed in direction, until the next call."""
        self.data.qfrc_applied[:] = 0
        body = self.bodies[min(i if i >= 0 else i + len(self.line), len(self.bodies) - 1)]
        mujoco.mj_applyFT(self.model, self.data, np.asarray(force_N, float), np.asarray(torque_Nm, float),
                          self.node(i), body, self.data.qfrc_applied)

    def settle(self, i, force_N=(0, 0, 0), torque_Nm=(0, 0, 0), most=6000):
        """Steps under a load, with damping raised, until nothing moves."""
        damping = self.model.dof_damping.copy()
        stiffness = np.zeros(self.model.nv)
        stiffness[self.model.jnt_dofadr] = self.model.jnt_stiffness[:, 0] if self.model.jnt_stiffness.ndim > 1 \
            else self.model.jnt_stiffness
        self.model.dof_damping[:] = 0.02 * stiffness + 1e-6
        for step in range(most):
            self.push(i, force_N, torque_Nm)
            mujoco.mj_step(self.model, self.data)
            if step > 200 and step % 50 == 0 and np.abs(self.data.qvel).max() < 1e-6:
                break
        self.model.dof_damping[:] = damping
        mujoco.mj_forward(self.model, self.data)

    def reset(self):
        mujoco.mj_resetData(self.model, self.data)
        mujoco.mj_forward(self.model, self.data)

    def twists(self, joint):
        """Whether a joint turns about the tube rather than across it."""
        return abs(self.model.jnt_axis[joint][2]) > 0.9

    def bend_joints(self):
        """For each joint node 1..n-1: ids of the hinges there, sorted by name, and the side: +1 where the link towards
        the tube's last node moves."""
        out = []
        for i in range(1, len(self.bodies)):
            child = i if self.model.body_parentid[self.bodies[i]] == self.bodies[i - 1] else i - 1
            first = self.model.body_jntadr[self.bodies[child]]
            ids = list(range(first, first + self.model.body_jntnum[self.bodies[child]]))
            if not ids:
                raise Refused(f"link {child} of the exported tube has no joint")
            out.append((ids, 1 if child == i else -1))
        return out
