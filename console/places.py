"""Where meshes live on this machine: run directories under .run/, the newest one current."""

import re
import shutil
import socket
import subprocess
import sys
from pathlib import Path

from deploy.launch import LaunchError, Mesh
from deploy.ports import is_free
from wire.site import Site, SiteError, load_site

RUN = Path(".run")
SITES = Path("deploy/sites")
ROUTER_PORT, VIEW_PORT = 7447, 9876
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


def prepare(name_or_path: str | None, seed: int, port: int | None, drones: int) -> Path:
    """Find the site file that is meant; without one, write that of the generated home with this seed and `drones`.

    The home takes the usual ports where they are free. `port`: of the router, instead of the one that the file says.
    """
    if name_or_path is None:
        return _home_of(seed, port, drones)
    found = named_site(name_or_path)
    return found if port is None else _on_port(found, port)


def named_site(name_or_path: str) -> Path:
    """The site file of that name, a path or what `sites` lists."""
    path, named = Path(name_or_path), SITES / f"{name_or_path}.toml"
    return named if not path.exists() and named.exists() else path


def _home_of(seed: int, port: int | None, drones: int) -> Path:
    folder = RUN / f"home-{seed}"
    _refuse_if_up(Mesh(folder), folder.name)  # the file that it runs from stays as it is
    router = free_port(ROUTER_PORT) if port is None else port
    view = free_port(VIEW_PORT)
    ports = ("--port", str(router), "--view-port", str(view))
    return generate_home(seed, folder / "site.toml", *ports, *flying(drones))


def flying(drones: int) -> tuple[str, ...]:
    """Options of the generator for so many drones, at ports that nobody else sends to."""
    return "--drones", str(drones), "--mavlink-port", str(free_udp_ports(drones))


def _on_port(file: Path, port: int) -> Path:
    """A copy of a site file with the router, and where it must the view, on another port."""
    site = load_site(file)
    folder = RUN / site.name
    _refuse_if_up(Mesh(folder), site.name)
    host = site.router.endpoint.rpartition(":")[0]
    text = with_value(file.read_text(), "router", "endpoint", f'"{host}:{port}"')
    text = with_value(text, "view", "grpc_port", str(free_port(site.view.grpc_port)))
    folder.mkdir(parents=True, exist_ok=True)
    copy = folder / "site.toml"
    copy.write_text(text)
    return copy


def with_value(toml: str, table: str, key: str, value: str) -> str:
    """The text of a TOML file with one value of one table replaced or added."""
    toml = toml.rstrip() + "\n"
    head = re.search(rf"^\[{table}\][^\n]*\n", toml, re.MULTILINE)
    if head is None:
        return f"{toml}\n[{table}]\n{key} = {value}\n"
    end = re.compile(r"^\[", re.MULTILINE).search(toml, head.end())
    body = toml[head.end() : end.start() if end else None]
    rest = re.sub(rf"^\s*{key}\s*=[^\n]*\n", "", body, flags=re.MULTILINE)
    return toml[: head.end()] + f"{key} = {value}\n" + rest + (toml[end.start() :] if end else "")


def generate_home(seed: int, out: Path, *options: str) -> Path:
    """Have the simulator write the site file of its home `seed`: floor plan and cameras, no object."""
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
    _refuse_if_up(mesh, site.name)
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


def _refuse_if_up(mesh: Mesh, name: str) -> None:
    if mesh.is_up():
        raise LaunchError(f"the mesh of {name} already runs; `justw down` stops it")


def free_udp_ports(count: int) -> int:
    """The first of so many UDP ports in a row that are free.

    Never 14540 and the like, though they may be free: autopilots send there unasked.
    """
    first = free_port()
    while not all(_is_free_udp(first + k) for k in range(count)):
        first = free_port()
    return first


def _is_free_udp(port: int) -> bool:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True


def free_port(preferred: int = 0) -> int:
    """The preferred port when it is free, else any free one."""
    if preferred and is_free(preferred):
        return preferred
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
    return port
