# SPDX-License-Identifier: GPL-3.0-or-later
"""The claims about a study and their verdicts as Markdown."""

from ..results.rows import entries
from ..tables.formats import escape_markdown
from .check import COARSE, FAILS, HOLDS, UNKNOWN


def claims_as_markdown(outcomes, results):
    """All claims of a study as a Markdown table."""
    counts = {verdict: sum(o.verdict == verdict for o in outcomes)
              for verdict in (HOLDS, FAILS, COARSE, UNKNOWN)}
    not_met = (f"the meshes are too coarse to judge {counts[COARSE]}" if results.is_quick
               else f"{counts[FAILS]} do not hold")
    lines = [f"# {results.study_title}: what holds of the thesis", "",
             f"Of {len(outcomes)} claims, {counts[HOLDS]} hold, {not_met}, and "
             f"{counts[UNKNOWN]} cannot be checked.", ""]
    lines += [sentence + "  " for sentence in caveats(results)]
    lines += ["", "| | Section | Claim | Criterion | Printed | Ours | |", "|:--|:--|:--|:--|:--|:--|:--|"]
    for outcome in outcomes:
        claim = outcome.claim
        cells = (claim["id"], claim["section"], claim["statement"], claim["criterion"],
                 outcome.printed, outcome.ours)
        lines.append("| " + " | ".join(escape_markdown(cell) for cell in cells)
                     + f" | {emphasized(outcome.verdict)} |")
    lines += known_reasons(outcomes)
    return "\n".join(lines) + "\n"


def emphasized(verdict):
    """A verdict as a table shows it: bold where a reader is to look."""
    return f"**{verdict}**" if verdict in (FAILS, UNKNOWN) else verdict


def known_reasons(outcomes):
    """Why claims may not hold, where it is known, as lines below the table."""
    failed = [o for o in outcomes if o.verdict == FAILS and o.note]
    lines = [f"- {', '.join(o.claim['id'] for o in failed if o.note == note)}: {escape_markdown(note)}"
             for note in dict.fromkeys(o.note for o in failed)]
    return ["", "Known reasons for what does not hold:", "", *lines] if lines else []


def caveats(results):
    """What a reader has to know before comparing the numbers, as sentences."""
    found = [results.note] if results.note else []
    found += ["All numbers come from the CSV files of this folder; printed ones from the tables and the "
              "text of the thesis. A dash is a number that is not there."]
    sizes = [f"{entry['name']} ({entry['n_cells']:,} cells)"
             for entry in entries(results.provenance, "meshes") if isinstance(entry.get("n_cells"), int)]
    scale = results.provenance.get("scale") or ""
    if sizes:
        found.append(f"Meshes{f' of the scale `{scale}`' if scale else ''}: {', '.join(sizes)}. Errors, "
                     "condition numbers and times depend on the size.")
    own = [mesh for mesh in results.meshes if not results.is_published(mesh)]
    if own:
        found.append(f"Not the meshes of the thesis but stand-ins for them: {', '.join(own)}.")
    return found
