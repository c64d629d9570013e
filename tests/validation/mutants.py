"""Wrong models on purpose: a fifth more of one thing in the exported XML must fail a check that else passes."""

import check_bending
import check_body
import check_rest
from suite import Check, Lab, Refused, edit

MORE = 1.2


def scaled(text, which=0):
    values = text.split()
    values[which] = f"{MORE * float(values[which]):.9g}"
    return " ".join(values)


def tube_bodies(root):
    return [b for b in root.iter("body") if b.get("name", "").startswith("tube")]


def friction(root):
    for geom in root.iter("geom"):
        geom.set("friction", scaled(geom.get("friction", "1")))


def joints(attribute):
    """Changes the first number of an attribute of all joints of tubes that have a spring."""
    def change(root):
        for body in tube_bodies(root):
            for joint in body.findall("joint"):
                if joint.get("stiffness") and joint.get(attribute):
                    joint.set(attribute, scaled(joint.get(attribute)))
    return change


def length(root):
    """All places within tubes but the first bodies' own, and the capsules' halves."""
    done = set()
    for body in tube_bodies(root):
        for element in body.iter():
            if element is body or id(element) in done:
                continue
            done.add(id(element))
            if element.get("pos"):
                element.set("pos", " ".join(f"{MORE * float(v):.9g}" for v in element.get("pos").split()))
            if element.tag == "geom":
                element.set("size", scaled(element.get("size"), 1))


MUTANTS = (("friction", friction, (check_rest.friction,)),
           ("bending stiffness", joints("stiffness"), (check_bending.elastica_once, check_bending.modes)),
           ("damping", joints("damping"), (check_bending.modes,)),
           ("length", length, (check_body.inertia, check_bending.elastica_once)))


def verdicts(lab, functions):
    out = {}
    for function in functions:
        try:
            out.update((check.name, check.passed()) for check in function(lab))
        except Refused:
            pass
    return out


def mutants(lab):
    for name, change, functions in MUTANTS:
        right = verdicts(lab, functions)
        wrong = Lab(lab.programs, lab.folder, lambda xml, change=change: edit(xml, change))
        wrong.cells = lab.cells
        broken = verdicts(wrong, functions)
        caught = [n for n in right if right[n] and not broken.get(n, False)]
        yield Check(f"{name} 20 % too large: checks that then fail", 1, len(caught), 0, "at least one must",
                    "; ".join(caught[:3]) or "none of those that pass on the right model", kind="least")
