"""Rerun runs without its telemetry and without its chatter; its errors are kept."""

import socket
import subprocess

from console.viewer import RERUN, quiet_environment


def _rerun(*words: str) -> subprocess.CompletedProcess[str]:
    with quiet_environment() as environment:
        return subprocess.run([RERUN, *words], capture_output=True, text=True, env=environment, timeout=60)


def test_telemetry_is_off() -> None:
    done = _rerun("analytics", "config")
    assert '"analytics_enabled": false' in done.stdout
    assert "Welcome" not in done.stdout + done.stderr


def test_only_errors_are_said() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        url = "rerun+http://127.0.0.1:9/proxy"
        done = _rerun("--serve-web", "--bind", "127.0.0.1", "--web-viewer-port", port, url)
    assert done.returncode != 0
    assert "Address already in use" in done.stderr
    assert "INFO" not in done.stdout + done.stderr
