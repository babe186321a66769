"""The measured figures as the table in `docs/detector.md`."""

from pathlib import Path
from typing import Any

BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


def table(figures: dict[str, Any]) -> str:
    """Markdown: the two cameras side by side, then every type."""
    cctv, mast = figures["cctv"], figures["mast"]
    lines = ["| | fixed camera, 640x480 | robot's camera, 320x240 with depth |", "|---|---|---|"]
    rows = [
        ("pictures / things that should be found", "pictures", "things"),
        ("precision / recall", "precision", "recall"),
    ]
    lines += [f"| {name} | {cctv[a]} / {cctv[b]} | {mast[a]} / {mast[b]} |" for name, a, b in rows]
    errors = [camera["position_error_m"] for camera in (cctv, mast)]
    lines.append(
        "| position error, median / p90 | " + " | ".join(f"{e['median']} / {e['p90']} m" for e in errors) + " |"
    )
    for prop in cctv["states"]:
        shown = [camera["states"].get(prop, {"accuracy": None, "seen": 0}) for camera in (cctv, mast)]
        lines.append(f"| {prop} right | " + " | ".join(f"{s['accuracy']} of {s['seen']}" for s in shown) + " |")
    lines.append(f"| one core, ms per picture | {cctv['look_ms']} | {mast['look_ms']} |")
    lines += ["", "| type | fixed: precision / recall (things) | robot: precision / recall (things) |", "|---|---|---|"]
    for name, one in cctv["types"].items():
        lines.append(f"| {name} | {_type(one)} | {_type(mast['types'][name])} |")
    return "\n".join(lines)


def _type(row: dict[str, Any]) -> str:
    return f"{row['precision']} / {row['recall']} ({row['things']})"


def write_report(path: Path, figures: dict[str, Any]) -> None:
    """Put the table between the two marks of a document."""
    before, _, rest = path.read_text().partition(BEGIN)
    _, _, after = rest.partition(END)
    path.write_text(f"{before}{BEGIN}\n{table(figures)}\n{END}{after}")
