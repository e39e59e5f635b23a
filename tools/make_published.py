#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""make_published.py SET REPOSITORY [PROGRAM]: makes the catalogue studies/published/SET.json of a set of meshes.

REPOSITORY is a local git repository, with or without a work tree, of the one that SETS names; the catalogue is that of
its commit HEAD. PROGRAM is smoothfem (default: build/release/bin/smoothfem). The rule is that of reason_to_leave_out."""

import hashlib
import json
import re
import subprocess
import sys
import tempfile
import urllib.parse
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FORMATS = (".mesh", ".vtk", ".vtu", ".msh", ".inp")
LEAST_FREE = 50  # nodes that a method can move
SOLID = {"tetrahedron", "hexahedron"}
SIDES = re.compile(r"_(in|out)$")

# most_nodes: larger meshes are left out, so that a study of a set takes about a quarter of an hour on two cores.
# families: what the name of a file without its ending may be, and its family; others are a family each.
SETS = {
    "hexalab": {
        "repository": "https://github.com/c4stan/HexaLab",
        "folder": "datasets/Practical Hex-Mesh Optimization via Edge-Cone Rectification",
        "licence": "The repository states none.",
        "most_nodes": 16000,
        "families": [(r"(.+?)(_stresstest)?_(in|out)", r"\1")]},
    "mesquite": {
        "repository": "https://github.com/trilinos/mesquite",
        "folder": "meshFiles",
        "licence": "LGPL-2.1-or-later",
        "most_nodes": 8000,
        "families": [(r"par_.*(quad|hex)_mesh.*", r"par_\1"), (r"(tangled_)?horse.*", "horse"), (r"(large|small)_box.*", "box"),
                     (r"(hole_in_square|hole_scheme|overt_hyb|pave|shashkov).*", r"\1")]},
    "sfepy": {
        "repository": "https://github.com/sfepy/sfepy",
        "folder": "meshes",
        "licence": "BSD-3-Clause",
        "most_nodes": 8000,
        "families": [(r"(circle_in_square|cube_medium|elbow|square)(_(quad|tri.?|unit_tri|small|hexa|tetra)|2)?", r"\1")]},
}


def git(repository, *arguments):
    """Returns the bytes that a command of git prints."""
    return subprocess.run(["git", "-C", repository, *arguments], check=True, stdout=subprocess.PIPE).stdout


def files_of(repository, folder):
    """Returns {path below the folder: object}; the object is None where the repository lacks it."""
    found = {}
    for line in git(repository, "ls-tree", "-r", "-l", "-z", "HEAD", f"{folder}/").decode().split("\0"):
        if line:
            facts, path = line.split("\t")
            _, _, name, size = facts.split()
            found[path[len(folder) + 1:]] = None if size == "BAD" else name
    return found


def smoothfem(program, *arguments):
    """Runs the program; returns its exit code, output, and last line of errors without the program's name."""
    outcome = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
    lines = outcome.stderr.strip().splitlines()
    return outcome.returncode, outcome.stdout, lines[-1].removeprefix("smoothfem: ") if lines else ""


def quality_of(program, file):
    """Returns the numbers of quality, and why there are none."""
    _, text, error = smoothfem(program, "quality", str(file), "--json")
    if not text:
        return {}, re.sub(rf"^{re.escape(str(file))}:?(\d+:)? *", "", error)
    return json.loads(text), ""


def reason_to_leave_out(program, file, quality, most_nodes):
    """Returns why a study has no use for a mesh, or an empty text. A study needs planar or volume cells that have finite elements and
    conform, LEAST_FREE free nodes and at most most_nodes nodes. The cells are valid, or the program can make them valid."""
    free = quality["n_nodes"] - quality["n_fixed_nodes"]
    if "n_corners" in quality:
        return "a surface"
    if any(cell.endswith("-gon") for cell in quality["cells"]):
        return "polygons"
    if len(quality["cells"]) > 1 and SOLID & set(quality["cells"]) or {"pyramid", "prism"} & set(quality["cells"]):
        return "volume cells that have no finite elements of degree 2 together"
    if quality["findings"]:
        return quality["findings"][0]["kind"].replace("-", " ")
    if free < LEAST_FREE:
        return f"fewer than {LEAST_FREE} free nodes ({free})"
    if quality["n_nodes"] > most_nodes:
        return f"more than {most_nodes:,} nodes ({quality['n_nodes']:,})"
    if quality["n_invalid"]:
        with tempfile.TemporaryDirectory() as folder:
            code, _, _ = smoothfem(program, "smooth", str(file), "--untangle", "-m", "smart-laplace", "-o", f"{folder}/out.vtk")
        if code:
            return f"tangled ({quality['n_invalid']} invalid cells), and cannot be untangled"
    return ""


def family_of(name, families):
    """Returns the family of a file, given its name without ending."""
    for pattern, family in families:
        if match := re.fullmatch(pattern, name):
            return match.expand(family)
    return name


def without_lone_sides(files, left_out):
    """Leaves out files NAME_in without NAME_out, and the reverse."""
    for path in list(files):
        side = SIDES.search(Path(path).stem)
        if side:
            other = re.sub(r"_(in|out)(\.\w+)$", r"_out\2" if side[1] == "in" else r"_in\2", path)
            if other not in files:
                left_out[path] = f"{other} is left out"
                del files[path]


def catalogue(chosen, repository, program):
    """Returns the catalogue of a set."""
    folder, commit = chosen["folder"], git(repository, "rev-parse", "HEAD").decode().strip()
    files, left_out, known = {}, {}, {}
    with tempfile.TemporaryDirectory() as temporary:
        for path, name in sorted(files_of(repository, folder).items()):
            if not path.endswith(FORMATS):
                continue
            if name is None:
                left_out[path] = "not in the copy of the repository that was used"
                continue
            content = git(repository, "cat-file", "blob", name)
            file = Path(temporary) / Path(path).name
            file.write_bytes(content)
            quality, reason = quality_of(program, file)
            reason = reason or reason_to_leave_out(program, file, quality, chosen["most_nodes"])
            numbers = tuple(quality.get(key) for key in ("n_nodes", "n_cells", "q_min", "q_mean"))
            if not reason and numbers in known:
                reason = f"the same mesh as {known[numbers]}"
            if reason:
                left_out[path] = reason
                continue
            known[numbers] = path
            files[path] = {"family": family_of(Path(path).stem, chosen["families"]), "sha256": hashlib.sha256(content).hexdigest()}
    without_lone_sides(files, left_out)
    owner = chosen["repository"].removeprefix("https://github.com/")
    return {"repository": chosen["repository"], "commit": commit, "licence": chosen["licence"],
            "address": f"https://raw.githubusercontent.com/{owner}/{commit}/{urllib.parse.quote(folder)}/",
            "files": files, "left_out": dict(sorted(left_out.items()))}


def main(arguments):
    """Runs the command line; returns the exit code."""
    if len(arguments) not in (2, 3) or arguments[0] not in SETS:
        print(f"{__doc__}\nSets: {', '.join(SETS)}", file=sys.stderr)
        return 2
    program = arguments[2] if len(arguments) == 3 else str(ROOT / "build/release/bin/smoothfem")
    made = catalogue(SETS[arguments[0]], arguments[1], program)
    path = ROOT / "studies" / "published" / f"{arguments[0]}.json"
    path.write_text(json.dumps(made, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    print(f"{path}: {len(made['files'])} files in {len({facts['family'] for facts in made['files'].values()})} families, "
          f"{len(made['left_out'])} left out")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
