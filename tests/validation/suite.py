"""What a check is, and the folder, programs and changes that all checks share."""

import dataclasses
import json
import os
import subprocess
import tomllib
import zlib
import xml.etree.ElementTree as ET

GRAVITY = 9.81  # m/s^2: central Europe, 45 to 50 degrees north.
SOURCE = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))


@dataclasses.dataclass
class Check:
    """One figure held against another. kind: "within" a tolerance, "most" or "least"."""

    name: str
    expected: float
    measured: float
    tolerance: float  # Relative to the expected value unless `absolute`; of a bound: none.
    reason: str  # Of the tolerance or bound.
    source: str  # Of the expected value.
    unit: str = ""
    kind: str = "within"
    absolute: bool = False

    def passed(self):
        if self.measured != self.measured:
            return False
        if self.kind == "most":
            return self.measured <= self.expected
        if self.kind == "least":
            return self.measured >= self.expected
        room = self.tolerance if self.absolute else self.tolerance * abs(self.expected)
        return abs(self.measured - self.expected) <= room

    def allowed(self):
        if self.kind != "within":
            return "at " + self.kind
        return f"± {self.tolerance:g} {self.unit}".rstrip() if self.absolute else f"± {100 * self.tolerance:g} %"


class Refused(Exception):
    """The program or its exported model lacks what a check needs."""


class Lab:
    """Where models come from. `change` is applied to every exported XML text: a mutant."""

    def __init__(self, programs, folder, change=None):
        self.programs, self.folder, self.change = programs, folder, change
        self.cells = {}

    def run(self, program, *arguments, allowed=(0,)):
        done = subprocess.run([os.path.join(self.programs, program), *arguments], capture_output=True, text=True,
                              cwd=self.folder)
        if done.returncode not in allowed:
            raise Refused(f"{program} {' '.join(arguments)}: exit {done.returncode}: {done.stderr.strip()[-400:]}")
        return done.stdout

    def part(self, shipped, **changes):
        """Values of a shipped part with changes, and the path of a part file that holds them."""
        with open(os.path.join(SOURCE, "models", "parts", shipped + ".toml"), "rb") as file:
            part = tomllib.load(file)
        part.update(changes)
        path = os.path.join(self.folder, f"part_{zlib.crc32(json.dumps(part, sort_keys=True).encode())}.toml")
        with open(path, "w") as file:
            file.writelines(f"{key} = {json.dumps(value)}\n" for key, value in part.items())
        return part, path

    def tube(self, path, centerline, rest=None, timestep_s=0.001):
        """XML of one tube alone, as every scene of the program builds it (tube_model.cc)."""
        scene = {"part": path, "centerline": [list(map(float, p)) for p in centerline], "timestep_s": timestep_s}
        if rest is not None:
            scene["rest_centerline"] = [list(map(float, p)) for p in rest]
        name = os.path.join(self.folder, "scene.json")
        with open(name, "w") as file:
            json.dump(scene, file)
        return self.changed(self.run("tube_model", name))

    def changed(self, xml):
        return self.change(xml) if self.change else xml


def edit(xml, function):
    """The XML text after `function` changed its root element."""
    root = ET.fromstring(xml)
    function(root)
    return ET.tostring(root, encoding="unicode")


def without(root, tag, keep=lambda element: False):
    """Removes all elements of a tag but those to keep."""
    for parent in list(root.iter()):
        for child in list(parent):
            if child.tag == tag and not keep(child):
                parent.remove(child)
