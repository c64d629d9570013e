#!/usr/bin/env python3
"""readme_test.py SOURCE_DIR BUILD_DIR: every command of README.md and CONTRIBUTING.md, run as it stands there in a folder
that holds this tree's folders by link and nothing else. What takes long is made shorter as SHORTER says. 77: the tree was
not built where `./dev` builds it."""

import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from checks import check, finish  # noqa: E402

SOURCE, BUILD = sys.argv[1:3]

# What a command begins with -> what is added to it, or put in its place: the same verb on less.
SHORTER = [
    ("build/bin/tubetwin run", "{} --set pile.count=1"),
    ("build/bin/tubetwin campaign run", "{} --set rounds=1 --set pile.count=1"),
    ("./dev test", "./dev test -R ^base.text$"),
    ("./dev lint", "./dev help"),  # clang-tidy is no package of the tests.
]
# What must be there after a command that begins so.
MAKES = [
    ("./dev demo", ["out/demo/video.mp4", "out/demo/report.html", "out/demo/summary.json"]),
    ("build/bin/tubetwin run", ["out/mine/report.html"]),
    ("build/bin/tubetwin campaign report", ["out/strategies/report.html"]),
]
PROSE = re.compile(r"^(\./dev|build/bin/|mkdir|cp) ?")


def commands(page):
    """The lines of the page's indented blocks without their remarks."""
    with open(os.path.join(SOURCE, page), encoding="utf-8") as file:
        lines = [line[4:].strip() for line in file if line.startswith("    ")]
    return [re.sub(r"\s+#.*", "", line) for line in lines if line]


def shortened(command):
    for begin, instead in SHORTER:
        if command.startswith(begin):
            return instead.format(command)
    return command


def run(command, folder):
    environment = dict(os.environ, TUBETWIN_NO_BUILD="1", DEMO_TUBES="1")
    done = subprocess.run(["bash", "-c", shortened(command)], cwd=folder, env=environment,
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=600)
    check(done.returncode == 0, f"'{command}' ends with 0: {done.returncode}\n"
                                f"{done.stdout[-1500:]}\n{done.stderr[-1500:]}")
    for begin, files in MAKES:
        if command.startswith(begin):
            for file in files:
                check(os.path.exists(os.path.join(folder, file)), f"'{command}' makes {file}")


def links_lead_somewhere(page):
    """The files that a page links to are there."""
    with open(os.path.join(SOURCE, page), encoding="utf-8") as file:
        for target in re.findall(r"\]\(([^)#]+)", file.read()):
            if "://" not in target:
                there = os.path.join(SOURCE, os.path.dirname(page), target)
                check(os.path.exists(there), f"{page} leads to {target}")


def main():
    if os.path.realpath(BUILD) != os.path.realpath(os.path.join(SOURCE, "build")):
        print("SKIPPED: the commands name build/, which is not", BUILD)
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        for name in os.listdir(SOURCE):
            if name not in ("out", ".git"):
                os.symlink(os.path.join(SOURCE, name), os.path.join(folder, name))
        ran = 0
        for page in ("README.md", "CONTRIBUTING.md"):
            for command in commands(page):
                check(PROSE.match(command), f"{page}: '{command}' is a command of this tree")
                run(command, folder)
                ran += 1
        check(ran > 8, f"commands were found: {ran}")
    for page in ("README.md", "CONTRIBUTING.md", "twin/architecture.md", "tests/benchmark/README.md",
                 "tests/benchmark/RESULTS.md"):
        links_lead_somewhere(page)
    finish()


main()
