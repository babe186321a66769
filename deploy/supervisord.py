"""The site file's process table as a configuration of supervisord."""

import os
import shlex
from dataclasses import dataclass
from pathlib import Path

from wire.process import SUPERVISED_VARIABLE
from wire.site import Process, Site

_FIRST = {"router": 10, "sim": 20}
"""Processes that others wait for are started first; all of them retry, so this only saves time."""

_HEAD = """\
[unix_http_server]
file={socket}
chmod=0700

[supervisord]
logfile={run}/supervisord.log
logfile_maxbytes=1MB
logfile_backups=1
pidfile={run}/supervisord.pid
nodaemon=false
silent=true
directory={cwd}

[rpcinterface:supervisor]
supervisor.rpcinterface_factory=supervisor.rpcinterface:make_main_rpcinterface
"""

_PROGRAM = """
[program:{id}]
command={python} -m {module} --site {site} --id {id}{args}
environment={environment}
priority={priority}
autostart={autostart}
autorestart=unexpected
exitcodes=2
startsecs=1
startretries=5
stopsignal=TERM
stopwaitsecs=8
stopasgroup=true
killasgroup=true
redirect_stderr=true
stdout_logfile={run}/log/{id}.log
stdout_logfile_maxbytes=5MB
stdout_logfile_backups=1
"""


@dataclass(frozen=True)
class Places:
    """Where one mesh keeps its things."""

    site_file: Path
    run_dir: Path
    socket: Path
    credentials: Path
    python: str


def render(site: Site, places: Places, host: str = "localhost") -> str:
    """Text of the configuration. Exit code 2 (wrong configuration) is not restarted: it would only fail again."""
    head = _HEAD.format(socket=_percent(places.socket), run=_percent(places.run_dir), cwd=_percent(Path.cwd()))
    return head + "".join(_program(row, places) for row in site.process if row.host == host)


def _program(row: Process, places: Places) -> str:
    return _PROGRAM.format(
        id=row.id,
        python=_word(places.python),
        module=row.module,
        site=_word(places.site_file),
        run=_percent(places.run_dir),
        args="".join(f" {_word(a)}" for a in row.args),
        priority=_FIRST.get(row.role, 100),
        autostart=str(row.autostart).lower(),
        environment=_environment(places),
    )


def _environment(places: Places) -> str:
    """One computing thread per process: the mesh has more processes than the machine has cores."""
    values = {
        "R2X_CREDENTIALS": str(places.credentials),
        "R2X_STATE": str(places.run_dir),
        SUPERVISED_VARIABLE: "1",
        "PYTHONPATH": os.environ.get("PYTHONPATH", ""),
        "PYTHONUNBUFFERED": "1",
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "LP_NUM_THREADS": "1",
    }
    return ",".join(f'{k}="{_percent(v)}"' for k, v in values.items() if v)


def _word(value: str | Path) -> str:
    """One word of a command line, which supervisord splits as a shell would."""
    return _percent(shlex.quote(str(value)))


def _percent(value: str | Path) -> str:
    """Supervisord expands %, and so a path with one must double it."""
    return str(value).replace("%", "%%")
