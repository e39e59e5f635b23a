# SPDX-License-Identifier: GPL-3.0-or-later
"""Says whether the smoothing times of a study compare with one another."""


def times_sentence(results):
    """A sentence on smoothing times that were not measured in one session; empty if they were."""
    sessions = {}
    for entry in results.provenance.get("results", []):
        if entry["mesh"] in results.meshes and entry["method"] in results.methods and "smoothed" in entry:
            sessions.setdefault(entry["smoothed"], []).append(results.title(entry["method"]))
    if len(sessions) < 2:
        return ""
    newest = max(sessions)
    others = list(dict.fromkeys(title for session, titles in sessions.items() if session != newest for title in titles))
    return (f"Times are of {len(sessions)} sessions: those of {', '.join(others)} are older. Compare them with care, or measure all in "
            "one session by --retime.")
