# SPDX-License-Identifier: GPL-3.0-or-later
"""Says whether the smoothing times of a study compare with one another."""


def times_sentence(results):
    """A sentence on the times of methods that were not measured in one session on the same mesh; empty if all were."""
    sessions = {mesh: set() for mesh in results.meshes}
    for entry in results.provenance.get("results", []):
        if entry["mesh"] in sessions and entry["method"] in results.methods and "smoothed" in entry:
            sessions[entry["mesh"]].add(entry["smoothed"])
    n = max(map(len, sessions.values()), default=0)
    if n < 2:
        return ""
    return (f"The smoothing times of a mesh come from up to {n} sessions: compare them with care, or measure all in one session by "
            "--retime.")
