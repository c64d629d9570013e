#!/usr/bin/env python3
"""Holds the exported models against theory with the stock engine (./dev validate).

  validate.py [--fast] [--bin build/bin] [--environment build/deps/validation] [--page VALIDATION.md] [--only TEXT]
              [--rods FOLDER]

--fast leaves out what takes minutes. --only runs groups whose title holds TEXT. --rods reads the DEFORM data set (rods.py).
Ends with 0 when nothing is outside that is not known to be, 1 otherwise, 77 without its Python environment.
"""

import argparse
import os
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.realpath(os.path.join(HERE, "..", ".."))

# Checks known to fail, and why. A check leaves this list when it passes.
KNOWN = {
    "pin of driver and coupler: farthest outside of the gripper's shapes": "shapes without the linkage",
    "pin of coupler and follower: farthest outside of the gripper's shapes": "shapes without the linkage",
}

MAY_DIVERGE = ("Real rods", "Mutants")  # A fit tries bad values, a mutant is one.


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fast", action="store_true")
    parser.add_argument("--bin", default=os.path.join(ROOT, "build", "bin"))
    parser.add_argument("--environment", default=os.path.join(ROOT, "build", "deps", "validation"))
    parser.add_argument("--page", help="write the page there")
    parser.add_argument("--only", default="")
    parser.add_argument("--rods", help="data_set folder of roahmlab/DEFORM")
    return parser.parse_args()


def enter(environment):
    """Goes on in the environment's Python; 77 where there is none."""
    python = os.path.join(environment, "bin", "python")
    if os.path.realpath(sys.prefix) == os.path.realpath(environment):
        return
    if not os.path.exists(os.path.join(environment, "complete")):
        print(f"SKIPPED: {environment} is not there; './dev test' makes it where there is a network")
        sys.exit(77)
    os.execv(python, [python, os.path.abspath(__file__), *sys.argv[1:]])


def groups(rods_folder):
    """Title, text, functions, and those left out by --fast."""
    import check_arm, check_bending, check_body, check_grip, check_gripper, check_helix, check_rest  # noqa: E401
    import check_scan, mutants, rods  # noqa: E401
    return (
        ("Bending and twist", "A hose of `hose_b`, straight, hooked or closed to a ring.",
         (check_bending.elastica, check_bending.modes, check_bending.hook, check_bending.torsion,
          check_bending.michell, check_helix.helix), (check_bending.hook_converges,)),
        ("Bodies", "Mass, inertia, length and motion of single tubes.",
         (check_body.inertia, check_body.fall, check_body.pendulum, check_body.energy), ()),
        ("Contact", "Three straight tubes in the cell's bin, and a tube on each surface of the cell, leaning until it "
         "slides.", (check_rest.rest, check_rest.friction, check_rest.drop, check_rest.drift), (check_rest.hoses,)),
        ("Grip", "A straight tube between the cell's pads, arm held still.", (check_grip.slip, check_grip.wrench), ()),
        ("Gripper's room", "Shapes of the cell's gripper at five openings.", (check_gripper.envelope,), ()),
        ("Arm", "The cell's arm without its tool, and the masses that hang on it.", (check_arm.kinematics_and_dynamics, check_arm.tools), ()),
        ("Scanner", "`tubetwin scan` of four straight tubes at four heights.", (check_scan.rays,), ()),
        ("Real rods", *rods.group(rods_folder), ()),
        ("Mutants", "The suite tests itself: models that are wrong by a fifth.", (mutants.mutants,), ()),
    )


def measure(lab, title, text, functions):
    import mujoco

    import page
    import suite
    group, begun, warnings = page.Group(title, text, []), time.monotonic(), []
    mujoco.set_mju_user_warning(warnings.append)
    for function in functions:
        try:
            group.checks += list(function(lab))
        except suite.Refused as refusal:
            name = f"{function.__module__}.{function.__name__}"
            group.checks.append(suite.Check(f"{name} can be made", 1, 0, 0, str(refusal), "this suite", kind="least"))
    if title not in MAY_DIVERGE:
        group.checks.append(suite.Check(f"{title}: warnings of the engine", 0, len(warnings), 0,
                                        warnings[0].strip() if warnings else "none is expected", "this suite",
                                        kind="most"))
    group.seconds = time.monotonic() - begun
    return group


def show(group):
    import page
    print(f"{group.title} ({group.seconds:.1f} s)")
    for check in group.checks:
        mark = {"within": "  ", "open": "o ", "**outside**": "X "}[page.verdict(check, KNOWN)]
        print(f"  {mark}{check.name}: {page.number(check.measured)} for {page.number(check.expected)} {check.unit} "
              f"({check.allowed()})", flush=True)


def main():
    choice = arguments()
    enter(choice.environment)
    sys.path.insert(0, HERE)
    import mujoco

    import page
    import rods
    import suite
    results = []
    with tempfile.TemporaryDirectory() as folder:
        lab = suite.Lab(os.path.abspath(choice.bin), folder)
        for title, text, fast, slow in groups(choice.rods):
            if choice.only.lower() in title.lower():
                results.append(measure(lab, title, text, fast if choice.fast else fast + slow))
                show(results[-1])
    if choice.rods:
        rods.remember([c for g in results for c in g.checks])
    if choice.page:
        with open(choice.page, "w") as file:
            file.write(page.page(results, KNOWN, mujoco.__version__))
    checks = [c for g in results for c in g.checks]
    outside = [c.name for c in checks if not c.passed() and c.name not in KNOWN]
    mended = [c.name for c in checks if c.passed() and c.name in KNOWN]
    print(f"{len(checks)} checks, {len(outside)} outside, {len([c for c in checks if not c.passed()]) - len(outside)} open")
    for name in mended:
        print(f"no longer open, take it off the list: {name}")
    return 1 if outside else 0


if __name__ == "__main__":
    sys.exit(main())
