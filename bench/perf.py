"""`./justw perf`: everything that is promised of speed and memory, measured in one run, beside its target.

Each measurement is a module of its own that prints JSON; this runs them one after the other, compares, and writes
out/perf/perf.json and out/perf/perf.png. A missed target is reported, never hidden; the exit code stays 0, because a
busy machine is no fault of the code. Stopped by Ctrl-C, it keeps what has been measured and exits with 130.
"""

import argparse
import json
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bench.plot import draw_rows

OUT = Path("out/perf")
END_S = 20.0
EXIT_INTERRUPTED = 130
Json = dict[str, Any]


@dataclass(frozen=True)
class Claim:
    """One figure of one measurement, and what it must reach."""

    name: str
    unit: str
    target: float
    at_least: bool
    read: Callable[[Json], float]


@dataclass(frozen=True)
class Section:
    module: str
    about: str
    claims: tuple[Claim, ...]
    arguments: tuple[str, ...] = ()


def _worst_makespan(document: Json) -> float:
    return max(float(case["ratio"]["search"]["median"]) for case in document["cases"])


def _role_mb(document: Json, role: str) -> float:
    return max(float(p["resident_mb"]) for p in document["processes"] if p["role"] == role)


SECTIONS: tuple[Section, ...] = (
    Section("bench.mesh", "the mesh: round trips, a burst, presence", (
        Claim("messages lost in a burst of 200,000", "", 0, False, lambda d: d["burst"]["lost"]),
        Claim("kill -9 noticed after", "ms", 100, False, lambda d: d["kill_noticed"]["median_ms"]),
        Claim("a frozen process noticed after", "ms", 1000, False, lambda d: d["freeze_noticed"]["median_ms"]),
    )),
    Section("hub.bench_fusion", "fusion of observations", (
        Claim("observations fused per second and core", "/s", 150_000, True, lambda d: d["observations_per_s"]),
        Claim("fusion over decoding alone", "x", 4, False, lambda d: d["ratio"]),
    )),
    Section("bench.fusion_latency", "observation on the wire to world state at a subscriber", (
        Claim("median over a bare round trip", "x", 3, False, lambda d: d["ratio"]),
        Claim("99th percentile", "ms", 5, False, lambda d: d["observation_to_world"]["p99_ms"]),
    )),
    Section("planners.bench_schedule", "schedules beside those of CP-SAT", (
        Claim("median makespan over the best found, worst size", "x", 1.1, False, _worst_makespan),
    ), ("--seeds", "3", "--limit-s", "3")),
    Section("sim.bench", "physics of a furnished home, one drone body and two robots", (
        Claim("times real time", "x", 100, True, lambda d: d["compound"]["real_time_factor"]),
        Claim("times real time with legs", "x", 15, True, lambda d: d["compound_with_legs"]["real_time_factor"]),
    )),
    Section("sim.render.bench", "cameras, 640x480 colour and ids", (
        Claim("pictures per second and core", "/s", 100, True, lambda d: d["gl_pictures_per_core_s"]),
        Claim("over PyBullet's own renderer", "x", 15, True, lambda d: d["ratio"]),
        Claim("ids equal to PyBullet's", "%", 99.5, True, lambda d: 100.0 * d["equal_ids"]),
    )),
    Section("bench.lockstep", "lockstep through the mesh, six devices at 20 Hz", (
        Claim("times real time", "x", 40, True, lambda d: d["times_real_time"]),
    )),
    Section("bench.footprint", "memory and start-up of the demo's mesh", (
        Claim("hub resident", "MB", 100, False, lambda d: _role_mb(d, "hub")),
        Claim("simulator resident", "MB", 300, False, lambda d: _role_mb(d, "sim")),
        Claim("camera process resident", "MB", 150, False, lambda d: _role_mb(d, "cctv")),
        Claim("view resident", "MB", 450, False, lambda d: _role_mb(d, "view")),
        Claim("eight light processes announced after", "s", 5, False, lambda d: d["eight_announced_s"]),
        Claim("robot process without vision resident", "MB", 40, False, lambda d: d["robot_without_vision"]["resident_mb"]),
    )),
    Section("bench.pixels", "the demo mesh with pixel perception", (
        Claim("times real time", "x", 2, True, lambda d: d["times_real_time"]),
    )),
    Section("sim.flight.bench", "the simulated quadrotor", (
        Claim("holds its place within (RMS)", "m", 0.05, False, lambda d: d["hold_rms_m"]["worst"]),
        Claim("overshoot of 10 m", "%", 10, False, lambda d: 100.0 * d["overshoot_of_10_m"]["worst"]),
        Claim("waypoint error", "m", 0.15, False, lambda d: d["waypoint_error_m"]["worst"]),
        Claim("landing error", "m", 0.5, False, lambda d: d["landing_error_m"]["worst"]),
        Claim("one vehicle, times real time", "x", 60, True, lambda d: d["times_real_time"]),
        Claim("ten vehicles, times real time", "x", 5, True, lambda d: d["times_real_time_10_vehicles"]),
    ), ("--png", "out/perf/flight.png")),
    Section("bench.sitl", "the light SITL and one client", (
        Claim("command to acknowledgement, median", "ms", 10, False, lambda d: d["answer_ms"]),
        Claim("one core per vehicle without cameras", "%", 25, False, lambda d: 100.0 * d["core_share_per_vehicle"]),
        Claim("started after", "s", 3, False, lambda d: d["start_s"]),
    )),
)  # fmt: skip


def run_section(section: Section) -> Json:
    """The JSON that a measurement prints, or what went wrong."""
    began = time.monotonic()
    command = [sys.executable, "-m", section.module, "--json", *section.arguments]
    # in a group of its own, so that Ctrl-C reaches it once, through `_end`
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, process_group=0) as child:
        try:
            said, faults = child.communicate()
        except KeyboardInterrupt:
            _end(child)
            raise
    took_s = round(time.monotonic() - began, 1)
    if child.returncode != 0:
        return {"error": faults.strip().splitlines()[-1:] or ["no output"], "took_s": took_s}
    text = said[said.index("{") :]
    document: Json = json.loads(text)
    return {**document, "took_s": took_s}


def _end(child: subprocess.Popen[str]) -> None:
    """It may have a mesh running, and is given the time to stop it."""
    child.send_signal(signal.SIGINT)
    try:
        child.communicate(timeout=END_S)
    except subprocess.TimeoutExpired:
        child.kill()


def judge(section: Section, document: Json) -> list[Json]:
    """One row for each claim: value, target, met."""
    if "error" in document:
        return [{"name": c.name, "error": document["error"], "met": False} for c in section.claims]
    rows = []
    for claim in section.claims:
        value = float(claim.read(document))
        met = value >= claim.target if claim.at_least else value <= claim.target
        rows.append(
            {"name": claim.name, "unit": claim.unit, "value": round(value, 3), "target": claim.target,
             "at_least": claim.at_least, "met": met}
        )  # fmt: skip
    return rows


def _line(row: Json) -> str:
    if "error" in row:
        return f"    FAILED  {row['name']}: {row['error'][0][:120]}"
    sign = ">=" if row["at_least"] else "<="
    return f"  {'ok' if row['met'] else 'MISSED':>8}  {row['name']}: {row['value']:g} {row['unit']} (target {sign} {row['target']:g})"


def _measure(sections: Sequence[Section], report: Json, *, quiet: bool) -> None:
    """One after the other into `report`, each told as it begins and ends unless `quiet`."""
    for number, section in enumerate(sections, start=1):
        if not quiet:
            print(f"[{number}/{len(sections)}] {section.about} ({section.module})", flush=True)
        document = run_section(section)
        rows = judge(section, document)
        report[section.module] = {"about": section.about, "claims": rows, "measured": document}
        if not quiet:
            print("\n".join(map(_line, rows)), f"           {document['took_s']:g} s", sep="\n", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print the JSON document instead of lines")
    parser.add_argument("--only", default="", help="only the measurements whose module contains this")
    arguments = parser.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)  # some sections draw there
    report: Json = {}
    wanted = [section for section in SECTIONS if arguments.only in section.module]
    try:
        _measure(wanted, report, quiet=arguments.json)
    except KeyboardInterrupt:
        print(f"stopped after {len(report)} of {len(wanted)} measurements", file=sys.stderr)
    (OUT / "perf.json").write_text(json.dumps(report, indent=2, sort_keys=True) + "\n")
    draw_rows([row for entry in report.values() for row in entry["claims"]], OUT / "perf.png")
    print(
        json.dumps(report, indent=2, sort_keys=True) if arguments.json else f"wrote {OUT}/perf.json and {OUT}/perf.png"
    )
    if len(report) < len(wanted):
        sys.exit(EXIT_INTERRUPTED)


if __name__ == "__main__":
    main()
