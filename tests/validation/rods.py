"""Real rods: both ends of a hose's chain follow recorded ones, the middle is compared.

Data: motion capture of cables moved by two robots, 100 frames a second, by the authors of DEFORM (Chen et al. 2024, CoRL,
arXiv 2406.05931): https://github.com/roahmlab/DEFORM, folder data_set. It states no licence, so it is no part of this tree:
fetch it yourself and pass --rods PATH/data_set. A file is a pickle of nested lists of numbers, frames x 3 x vertices; nothing
else is let out of it.

As its authors do (train_DEFORM.py, evaluation): the rod starts in the second frame, with the speed from the first; the
first two and last two vertices follow the recording; 498 frames are predicted from nothing but those. Their figure is the
mean over frames, all vertices (the driven ones included) and axes of the absolute error; their own record of it
(loss_record/eval_loss_*.pkl) begins with the value before any learning, which is what their rod of textbook physics gives.
"""

import dataclasses
import glob
import json
import os
import pickle

import mujoco
import numpy as np

import theory
from rod import Rod
from suite import Check, Refused, edit

FRAME_S, STEP_S, TIE_S = 0.01, 0.002, 0.004
# First value of the authors' loss_record/eval_loss_DLOn.pkl, and its smallest, after learning; metres.
UNLEARNED = {"DLO1": 0.0261, "DLO2": 0.0297, "DLO3": 0.0283, "DLO4": 0.0388}
LEARNED = {"DLO1": 0.0111, "DLO2": 0.0102, "DLO3": 0.0099, "DLO4": 0.0115}
RADIUS_M, KG_PER_M = 0.005, 1.0  # Nothing is touched: only EI over weight matters.


class NumbersOnly(pickle.Unpickler):
    def find_class(self, module, name):
        raise pickle.UnpicklingError(f"{module}.{name}: a recording holds lists of numbers only")


def load(path):
    """Frames x vertices x 3, metres."""
    with open(path, "rb") as file:
        frames = np.array(NumbersOnly(file).load(), float)
    if frames.ndim != 3 or frames.shape[1] != 3 or frames.shape[0] < 10 or frames.shape[2] < 6:
        raise ValueError(f"{path}: {frames.shape} numbers; allowed: 10 frames or more x 3 x 6 vertices or more")
    return frames.transpose(0, 2, 1)


def with_ends(xml, nodes):
    """Adds four points that are moved from outside, and ties the first two and last two nodes to them."""
    ends = [0, 1, len(nodes) - 2, len(nodes) - 1]

    def change(root):
        world = root.find("worldbody")
        for i in ends:
            place = " ".join(map(str, nodes[i]))
            world.append(world.makeelement("body", {"name": f"end{i}", "mocap": "true", "pos": place}))
    return edit(xml, change), ends


def driven(lab, line, EI, loss_s):
    """A straight hose of that stiffness and of joints whose damping is `loss_s` times it, bent along a line, with its ends
    tied. Returns the rod and the ends."""
    count = len(line) - 1
    length = float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
    _, path = lab.part("hose_b", length_m=length, radius_m=RADIUS_M, mass_kg=KG_PER_M * length,
                       bending_stiffness_Nm2=EI, bending_stiffness_range_Nm2=[EI, EI])
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    rest = np.column_stack([s, np.zeros(count + 1), np.ones(count + 1)])
    xml, ends = with_ends(lab.tube(path, line, rest=rest, timestep_s=STEP_S), line)
    plain = Rod(xml, line)

    def tie(root):
        for joint in root.iter("joint"):
            if joint.get("stiffness"):
                joint.set("damping", str(loss_s * float(joint.get("stiffness").split()[0])))
        section = root.makeelement("equality", {})
        for i in ends:
            body = plain.bodies[min(i, count - 1)]
            section.append(section.makeelement("connect", {
                "body1": plain.model.body(body).name, "body2": f"end{i}", "solref": f"{TIE_S} 1", "solimp": "0.9999 0.9999",
                "anchor": " ".join(map(str, plain.to_body(body, line[i])))}))
        root.append(section)

    rod = Rod(edit(xml, tie), line)
    rod.model.opt.gravity[2] = -9.81
    return rod, ends


def start(rod, before, now):
    """Gives the rod the speed that its nodes have between two frames, as nearly as its joints allow."""
    m, d = rod.model, rod.data
    rows, wanted = [], ((now - before) / FRAME_S).ravel()
    jacobian = np.zeros((3, m.nv))
    for i in range(len(rod.line)):
        mujoco.mj_jac(m, d, jacobian, None, rod.node(i), rod.bodies[min(i, len(rod.bodies) - 1)])
        rows.append(jacobian.copy())
    J = np.vstack(rows)
    d.qvel[:] = np.linalg.solve(J.T @ J + 1e-4 * np.eye(m.nv), J.T @ wanted)


def follow(rod, ends, before, now):
    """One frame: the ends go from where they were to where they are. What moves from outside has no speed for the engine, so
    a tie lags by twice its time constant: the points are ahead by that."""
    mocap = [rod.model.body(f"end{i}").mocapid[0] for i in ends]
    steps = int(round(FRAME_S / STEP_S))
    for k in range(1, steps + 1):
        rod.data.mocap_pos[mocap] = before + (now - before) * (k / steps + 2 * TIE_S / FRAME_S)
        mujoco.mj_step(rod.model, rod.data)
    mujoco.mj_kinematics(rod.model, rod.data)
    return rod.nodes()


def predict(lab, frames, EI, loss_s):
    """Nodes of the rod at frames 2, 3, ... when its ends follow the recording."""
    rod, ends = driven(lab, frames[1], EI, loss_s)
    start(rod, frames[0], frames[1])
    out = np.full((len(frames) - 2, *frames.shape[1:]), np.nan)
    for i, (before, now) in enumerate(zip(frames[1:-1], frames[2:])):
        out[i] = follow(rod, ends, before[ends], now[ends])
        if not np.abs(out[i]).max() < 10:  # Diverged: no score.
            break
    return out


def errors(predicted, frames):
    """Mean absolute error of all vertices and axes as the authors count; mean distance of the middle vertices."""
    off = predicted - frames[2:]
    return np.abs(off).mean(), np.linalg.norm(off[:, 2:-2], axis=2).mean()


def score(lab, files, EI, loss_s):
    """Both errors, mean over recordings, metres."""
    out = []
    for path in files:
        frames = load(path)
        out.append(errors(predict(lab, frames, EI, loss_s), frames))
    return np.nan_to_num(np.array(out), nan=np.inf).mean(axis=0)


# Stiffness over weight: EI for 1 kg/m, and the joints' damping over their stiffness.
STIFFNESSES, LOSSES = (0.005, 0.01, 0.02, 0.04, 0.08), (0.03, 0.1, 0.3)


def fitted(lab, folder, files=6):
    """The pair that fits some of the training recordings best: the only two numbers that are fitted."""
    paths = sorted(glob.glob(os.path.join(folder, "train", "*.pkl")))
    paths = paths[::max(1, len(paths) // files)][:files]
    return min(((EI, loss) for EI in STIFFNESSES for loss in LOSSES), key=lambda pair: score(lab, paths, *pair)[0])


def real(lab, folder):
    for name in UNLEARNED:
        paths = sorted(glob.glob(os.path.join(folder, name, "eval", "*.pkl")))
        if not paths:
            raise Refused(f"{folder} has no {name}/eval/*.pkl; allowed: data_set of roahmlab/DEFORM")
        EI, loss = fitted(lab, os.path.join(folder, name))
        all_vertices, middle = score(lab, paths, EI, loss)
        yield Check(f"{name}, {len(paths)} recordings of 5 s: mean absolute error", 1e3 * UNLEARNED[name],
                    1e3 * all_vertices, 0, f"stiffness and damping fitted to 6 other recordings; the authors reach "
                    f"{1e3 * LEARNED[name]:.1f} after learning; mean distance of the middle {1e3 * middle:.0f} mm",
                    "the authors' own record before learning", "mm", kind="most")


def synthetic(lab):
    """A file of the data set's form from a rod of known stiffness: read, followed, and told from a stiffer one."""
    spacing = np.concatenate([[0, 0.025], 0.025 + 0.095 * np.arange(1, 11), [1.0]])
    line = theory.at_arc_length(theory.arc_line([(1.0, 0.8 * np.pi)]), spacing)
    hanging = np.column_stack([line[:, 1], line[:, 2], 1.0 - line[:, 0]])
    rod, ends = driven(lab, hanging, 0.02, 0.1)
    place, frames = hanging[ends], []
    for _ in range(100):
        follow(rod, ends, place, place)
    for frame in range(102):
        t = frame * FRAME_S
        now = hanging[ends] + [[0.06 * (1 - np.cos(4 * t)), 0.05 * (1 - np.cos(6 * t)), 0.05 * (1 - np.cos(5 * t))]] * 4
        frames.append(follow(rod, ends, place, now))
        place = now
    path = os.path.join(lab.folder, "synthetic.pkl")
    with open(path, "wb") as file:
        pickle.dump([f.T.tolist() for f in frames], file)
    _, right = score(lab, [path], 0.02, 0.1)
    _, wrong = score(lab, [path], 0.08, 0.1)
    yield Check("synthetic recording of a known rod: mean distance of the middle", 0.5, 1e3 * right, 0,
                "starting speeds from two frames", "the rod that made it", "mm", kind="most")
    yield Check("the same followed by a rod four times as stiff", 10.0, 1e3 * wrong, 0, "the score must tell them apart",
                "this suite", "mm", kind="least")


TEXT = """A hose whose ends follow recorded ones; the middle is compared. Recordings: DEFORM (Chen et al. 2024), fetched by the
user, `./dev validate --rods PATH/data_set`; no licence is stated, so none is kept here. Stiffness over weight and damping
are fitted to six other recordings of the same cable, which the authors' value before learning is not: it has a guess.

"""
SAID = os.path.join(os.path.dirname(os.path.abspath(__file__)), "rods_measured.json")


def remembered(lab):
    """What the last run with recordings found."""
    with open(SAID) as file:
        yield from (Check(**row) for row in json.load(file))


def remember(checks):
    with open(SAID, "w") as file:
        json.dump([dataclasses.asdict(c) for c in checks if c.name[:3] == "DLO"], file, indent=1, sort_keys=True)
        file.write("\n")


def group(folder):
    """Text and functions."""
    if folder:
        return TEXT + "All rows are of this run.", (synthetic, lambda lab: real(lab, os.path.abspath(folder)))
    if os.path.exists(SAID):
        return TEXT + "Rows of recordings are those of the last run that was given them.", (synthetic, remembered)
    return TEXT + "Real recordings: **not measured**; only a synthetic one was followed.", (synthetic,)
