"""Rerun runs without its telemetry and without its chatter; its errors are kept."""

import socket
import subprocess
import time

from console.places import free_port
from console.viewer import quiet_environment, rerun_program
from deploy.ports import is_free


def _rerun(*words: str) -> subprocess.CompletedProcess[str]:
    with quiet_environment() as environment:
        return subprocess.run([rerun_program(), *words], capture_output=True, text=True, env=environment, timeout=60)


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


def test_who_ends_the_viewer_leaves_nothing_behind() -> None:
    """Only the process that was started is told to end, as `record` does."""
    port = free_port()
    words = [rerun_program(), "--serve-web", "--bind", "127.0.0.1", "--web-viewer-port", str(port)]
    with quiet_environment() as environment:
        process = subprocess.Popen([*words, "rerun+http://127.0.0.1:9/proxy"], env=environment)
        deadline = time.monotonic() + 30.0
        while is_free(port):
            assert time.monotonic() < deadline
            time.sleep(0.05)
        process.terminate()
        process.wait(timeout=30.0)
    assert is_free(port)
