"""Wrong models on purpose: a fifth more of one thing in the exported XML must fail a check that else passes."""

import check_bending
import check_body
import check_rest
import theory
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


def springs(root):
    """Joints of tubes that have a spring."""
    return [j for b in tube_bodies(root) for j in b.findall("joint") if j.get("stiffness")]


def stiffness(root):
    for joint in springs(root):
        joint.set("stiffness", scaled(joint.get("stiffness")))


def damping_of(lab):
    """A fifth more than the stated loss factor asks for, which joints and steps give together."""
    part, _ = lab.part("hose_b")
    omega = theory.free_free_frequency(0, part["bending_stiffness_Nm2"], part["mass_kg"] / part["length_m"],
                                       part["length_m"])

    def change(root):
        for joint in springs(root):
            more = (MORE - 1) * check_bending.loss_factor(part) / omega * float(joint.get("stiffness").split()[0])
            joint.set("damping", f"{float(joint.get('damping', '0').split()[0]) + more:.9g}")
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


def wrong_models(lab):
    """Name, change of the XML, checks to ask."""
    return (("friction", friction, (check_rest.friction,)),
            ("bending stiffness", stiffness, (check_bending.elastica_once, check_bending.modes)),
            ("damping", damping_of(lab), (check_bending.modes,)),
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
    for name, change, functions in wrong_models(lab):
        right = verdicts(lab, functions)
        wrong = Lab(lab.programs, lab.folder, lambda xml, change=change: edit(xml, change))
        wrong.cells = lab.cells
        broken = verdicts(wrong, functions)
        caught = [n for n in right if right[n] and not broken.get(n, False)]
        yield Check(f"{name} 20 % too large: checks that then fail", 1, len(caught), 0, "at least one must",
                    "; ".join(caught[:3]) or "none of those that pass on the right model", kind="least")
