"""Where meshes live on this machine: run directories under .run/, the newest one current."""

import shutil
import socket
import subprocess
import sys
from pathlib import Path

from deploy.launch import LaunchError, Mesh
from wire.site import Site, SiteError, load_site

RUN = Path(".run")
SITES = Path("deploy/sites")
_CURRENT = RUN / "current"


def current_mesh() -> Mesh:
    """The mesh that commands without a name mean: the one started last, or when it has ended another that runs."""
    if not _CURRENT.exists():
        raise SiteError("no mesh has been started here yet; `justw up` starts one")
    newest = Mesh(_CURRENT.resolve())
    if newest.is_up():
        return newest
    others = (Mesh(file.parent) for file in sorted(RUN.glob("*/supervisord.conf")))
    return next((mesh for mesh in others if mesh.is_up()), newest)


def known_sites() -> list[Path]:
    return sorted(SITES.glob("*.toml"))


def prepare(name_or_path: str | None, seed: int) -> Path:
    """Find the site file that is meant; without one, write that of the generated home with this seed."""
    if name_or_path is None:
        return generate_home(seed, RUN / f"home-{seed}" / "site.toml")
    path = Path(name_or_path)
    named = SITES / f"{name_or_path}.toml"
    return named if not path.exists() and named.exists() else path


def generate_home(seed: int, out: Path, *options: str) -> Path:
    """Have the simulator write the site file of its home `seed`: floor plan and cameras, no object."""
    out.parent.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, "-m", "sim.generator", "--seed", str(seed), "--out", str(out), *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        words = done.stderr.strip().splitlines()[-1:] or ["no reason given"]
        raise SiteError(f"the home of seed {seed} could not be generated: {words[0].removeprefix('error: ')}")
    return out


def install_site(path: Path) -> tuple[Site, Mesh]:
    """Check the file, give it a run directory, and make that the current mesh. Raises SiteError, LaunchError."""
    site = load_site(path)
    run_dir = RUN / site.name
    run_dir.mkdir(parents=True, exist_ok=True)
    mesh = Mesh(run_dir)
    if mesh.is_up():
        raise LaunchError(f"the mesh of {site.name} already runs; `justw down` stops it")
    if path.resolve() != mesh.site_file:
        shutil.copyfile(path, mesh.site_file)
    if site.sim is not None:
        _forget(run_dir)
    _CURRENT.unlink(missing_ok=True)
    _CURRENT.symlink_to(run_dir.name, target_is_directory=True)
    return site, mesh


def _forget(run_dir: Path) -> None:
    """A simulated building starts anew with its mesh: what was remembered of the last run is not true of it."""
    for file in run_dir.glob("*.sqlite*"):
        file.unlink()


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
    return port
