# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers in the thesis of the figures of its studies; any other figure has no number."""

THESIS_NUMBERS = {
    "planar": {"meshes": "5_2"},
    "surface": {"meshes": "5_4"},
    "bridge": {"meshes": "5_6"},
    "sphere": {"meshes": "5_7", "history": "5_8", "histograms": "5_9"},
    "prosthesis": {"meshes": "5_11", "history": "5_12", "histograms": "5_13"},
    "axle": {"meshes": "5_15", "history": "5_16"},
    "nonuniform-grid": {"plane_sections": "5_18", "history": "5_19"},
    "subdivision": {"meshes": "5_21", "histograms": "5_22", "history": "5_23"},
    "sweep": {"meshes": "5_25", "histograms": "5_26", "history": "5_27"},
    "car": {"meshes": "5_31", "histograms": "5_30", "histogram_differences": "5_33",
            "history": "5_34"},
    "plate": {"element_types": "5_35", "meshes": "5_36", "histograms": "5_37", "history": "5_38"},
    "ring": {"element_types": "5_39", "meshes": "5_40", "histograms": "5_41", "history": "5_42"},
    "aorta": {"element_types": "5_43", "meshes": "5_44", "histograms": "5_45", "history": "5_46"},
    "warpage": {"history": "5_47"},
    "piston": {"meshes": "5_49", "history": "5_50"},
    "pump": {"meshes": "5_52", "history": "5_53"},
    "gear": {"model": "6_2", "meshes": "6_3", "history": "6_4"},
    "volume": {"model": "6_5", "meshes": "6_6", "histograms": "6_7", "history": "6_8"}}
# The degree whose errors the history figure shows; the lowest one for any other study.
HISTORY_DEGREES = {"volume": "2"}


def figure_name(study, kind, variant=""):
    """The file name without suffix: figure_6_4_history_log_time, or history_log_time for a study that is not in the
    thesis; `study` as in Results.thesis_study."""
    numbers = THESIS_NUMBERS.get(study)
    if numbers is None:
        return kind + variant
    return "_".join(["figure"] + ([numbers[kind]] if kind in numbers else []) + [kind]) + variant
