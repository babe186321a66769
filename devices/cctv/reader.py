"""The thread that waits for a camera, so that the core never does."""

import logging
import threading

from devices.cctv.sources import FrameSource, SourceEnded, SourceLost, SourceWrong, open_source
from devices.vision.lens import Image
from wire.site import Camera

log = logging.getLogger("camera")

BACK_OFF_S = (0.5, 1.0, 2.0, 5.0, 10.0)


class SourceReader:
    """Keeps the newest picture of one source; a lost source is opened again, ever less often."""

    def __init__(self, camera: Camera) -> None:
        self._camera = camera
        self._lock = threading.Lock()
        self._newest: Image | None = None
        self._fault = ""
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"source-{camera.id}", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._stopping.set()
        if self._thread.ident is not None:
            self._thread.join(timeout=2.0)

    def take(self) -> Image | None:
        """The newest picture not yet taken."""
        with self._lock:
            picture, self._newest = self._newest, None
            return picture

    @property
    def fault(self) -> str:
        """Why there will never be pictures again; empty while there may be."""
        with self._lock:
            return self._fault

    def _run(self) -> None:
        attempt = 0
        while not self._stopping.is_set():
            try:
                source = open_source(self._camera)
            except SourceLost as lost:
                attempt = self._wait(attempt, lost)
                continue
            except SourceWrong as wrong:
                self._give_up(wrong)
                return
            attempt = 0
            try:
                self._pump(source)
            except SourceLost as lost:
                attempt = self._wait(attempt, lost)
            except SourceEnded as ended:
                log.info("%s", ended)
                return
            except SourceWrong as wrong:
                self._give_up(wrong)
                return
            finally:
                source.close()

    def _pump(self, source: FrameSource) -> None:
        while not self._stopping.is_set():
            picture = source.read()
            with self._lock:
                self._newest = picture
            if source.interval_s > 0.0:
                self._stopping.wait(source.interval_s)

    def _wait(self, attempt: int, lost: SourceLost) -> int:
        pause_s = BACK_OFF_S[min(attempt, len(BACK_OFF_S) - 1)]
        log.warning("%s; trying again in %g s", lost, pause_s)
        self._stopping.wait(pause_s)
        return attempt + 1

    def _give_up(self, wrong: SourceWrong) -> None:
        with self._lock:
            self._fault = str(wrong)
