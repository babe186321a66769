"""The measured figures as the table in `docs/detector.md`."""

from pathlib import Path
from typing import Any

from wire.catalogue import PROPS

BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


CAMERAS = {
    "home": "home as it is, its own cameras",
    "cctv": "home in disorder, fixed camera",
    "mast": "home in disorder, robot's camera with depth",
}


def table(figures: dict[str, Any]) -> str:
    """Markdown: the cameras side by side, then every type."""
    columns = [figures[name] for name in CAMERAS]
    lines = ["| | " + " | ".join(CAMERAS.values()) + " |", "|---|---|---|---|"]

    def row(name: str, cells: list[str]) -> None:
        lines.append(f"| {name} | " + " | ".join(cells) + " |")

    row("pictures / things that should be found", [f"{c['pictures']} / {c['things']}" for c in columns])
    row("precision / recall", [f"{c['precision']} / {c['recall']}" for c in columns])
    errors = [c["position_error_m"] for c in columns]
    row("position error, median / p90", [f"{e['median']} / {e['p90']} m" for e in errors])
    for prop in PROPS:
        states = [c["states"].get(prop, {"accuracy": None, "seen": 0}) for c in columns]
        row(f"{prop} right", [f"{s['accuracy']} of {s['seen']}" for s in states])
    row("one core, ms per picture", [str(c["look_ms"]) for c in columns])
    lines += ["", "Precision / recall (things) by type:", "", lines[0], lines[1]]
    for name in columns[0]["types"]:
        row(name, [_type(c["types"][name]) for c in columns])
    return "\n".join(lines)


def _type(row: dict[str, Any]) -> str:
    return f"{row['precision']} / {row['recall']} ({row['things']})"


def write_report(path: Path, figures: dict[str, Any]) -> None:
    """Put the table between the two marks of a document."""
    before, _, rest = path.read_text().partition(BEGIN)
    _, _, after = rest.partition(END)
    path.write_text(f"{before}{BEGIN}\n{table(figures)}\n{END}{after}")
