"""A small RTSP camera: ffmpeg makes the pictures and packets, this answers the requests and passes packets on."""

import shutil
import socket
import subprocess
import threading
from pathlib import Path

FFMPEG = shutil.which("ffmpeg")


class RtspCamera:
    """rtsp://127.0.0.1:<port>/live, H.264 over the RTSP connection itself; one viewer at a time."""

    def __init__(self, folder: Path, size: str = "640x480", rate_hz: int = 10) -> None:
        assert FFMPEG is not None
        self._packets = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._packets.bind(("127.0.0.1", 0))
        self._packets.settimeout(0.2)
        self._door = socket.create_server(("127.0.0.1", 0))
        self.url = f"rtsp://127.0.0.1:{self._door.getsockname()[1]}/live"
        self._description = folder / "camera.sdp"
        picture = f"testsrc=size={size}:rate={rate_hz}"
        codec = ["-c:v", "libx264", "-preset", "ultrafast", "-tune", "zerolatency", "-g", "5", "-pix_fmt", "yuv420p"]
        target = f"rtp://127.0.0.1:{self._packets.getsockname()[1]}?pkt_size=1200"
        command = [FFMPEG, "-loglevel", "error", "-re", "-f", "lavfi", "-i", picture, *codec, "-bsf:v", "dump_extra"]
        self._ffmpeg = subprocess.Popen([*command, "-f", "rtp", "-sdp_file", str(self._description), target])
        self._playing: socket.socket | None = None
        self._stopping = threading.Event()
        self._threads = [threading.Thread(target=run, daemon=True) for run in (self._pass_on, self._answer)]
        for thread in self._threads:
            thread.start()

    def close(self) -> None:
        self._stopping.set()
        self._ffmpeg.terminate()
        self._ffmpeg.wait()
        if self._playing is not None:
            self._playing.shutdown(socket.SHUT_RDWR)
        self._door.shutdown(socket.SHUT_RDWR)
        for thread in self._threads:
            thread.join(timeout=5.0)
        self._door.close()
        self._packets.close()

    def _pass_on(self) -> None:
        """Every packet of ffmpeg to the viewer, framed as RFC 2326 section 10.12 has it."""
        while not self._stopping.is_set():
            try:
                packet = self._packets.recv(65536)
            except TimeoutError:
                continue
            if self._playing is not None:
                try:
                    self._playing.sendall(b"$\0" + len(packet).to_bytes(2, "big") + packet)
                except OSError:
                    self._playing = None

    def _answer(self) -> None:
        while not self._stopping.is_set():
            try:
                viewer, _ = self._door.accept()
            except OSError:
                return
            with viewer:
                self._serve(viewer)

    def _serve(self, viewer: socket.socket) -> None:
        stream = viewer.makefile("rb")
        while (request := self._request(stream)) is not None:
            method, number = request
            head = f"RTSP/1.0 200 OK\r\nCSeq: {number}\r\nSession: 1\r\n"
            body = ""
            if method == "OPTIONS":
                head += "Public: OPTIONS, DESCRIBE, SETUP, PLAY, TEARDOWN\r\n"
            elif method == "DESCRIBE":
                body = self._sdp()
                head += f"Content-Type: application/sdp\r\nContent-Length: {len(body)}\r\n"
            elif method == "SETUP":
                head += "Transport: RTP/AVP/TCP;unicast;interleaved=0-1\r\n"
            viewer.sendall(f"{head}\r\n{body}".encode())
            if method == "PLAY":
                self._playing = viewer
            if method == "TEARDOWN":
                return

    def _request(self, stream) -> tuple[str, str] | None:
        """Method and number of the next request; receiver reports between requests are skipped."""
        lines: list[str] = []
        while not lines or lines[-1]:
            try:
                first = stream.peek(1)[:1]
                if first == b"$":
                    header = stream.read(4)
                    stream.read(int.from_bytes(header[2:], "big"))
                    continue
                line = stream.readline()
            except (OSError, ValueError):
                return None
            if not line:
                return None
            lines.append(line.decode().strip())
        number = next(line.split(":")[1].strip() for line in lines if line.lower().startswith("cseq"))
        return lines[0].split()[0], number

    def _sdp(self) -> str:
        while not self._description.exists() or "a=fmtp" not in self._description.read_text():
            if self._stopping.wait(0.05):
                return ""
        lines = self._description.read_text().replace("SDP:\n", "").split("\n")
        return "\r\n".join(line.strip() for line in lines if line.strip()) + "\r\na=control:track1\r\n"
