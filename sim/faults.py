"""What goes wrong on purpose: pictures that are lost or late, appliances that report the wrong state. Seeded."""

from collections import deque
from collections.abc import Iterable
from random import Random

from wire.messages.driver import CameraFrame, DeviceReport
from wire.site import Fault


class Faults:
    """Each fault of each device draws from a generator of its own, so that one does not change another."""

    def __init__(self, faults: Iterable[Fault], seed: int) -> None:
        self._faults = tuple(faults)
        self._random = [Random(f"{seed}/{k}/{f.device}/{f.kind}") for k, f in enumerate(self._faults)]
        self._late: deque[tuple[float, CameraFrame]] = deque()

    def pass_frame(self, frame: CameraFrame, now_s: float) -> None:
        """Take a picture on its way out; what is left of it comes from `due_frames`."""
        delay_s = 0.0
        for fault, random in self._of(frame.camera):
            if fault.kind == "wrong_state" or random.random() >= fault.probability:
                continue
            if fault.kind == "frame_loss":
                return
            delay_s += fault.delay_s
        self._late.append((now_s + delay_s, frame))

    def due_frames(self, now_s: float) -> list[CameraFrame]:
        """Pictures whose time has come, oldest first; their stamps stay those of the exposure."""
        due = [frame for at_s, frame in self._late if at_s <= now_s + 1e-9]
        self._late = deque(row for row in self._late if row[0] > now_s + 1e-9)
        return due

    def distort(self, report: DeviceReport) -> DeviceReport:
        """A report with the properties turned round that a fault names (all of them when it names none)."""
        props = dict(report.props)
        for fault, random in self._of(report.device):
            if fault.kind == "wrong_state" and random.random() < fault.probability:
                for name in props:
                    if fault.prop is None or fault.prop == name:
                        props[name] = 1.0 - props[name]
        return report.model_copy(update={"props": props})

    def _of(self, device: str) -> list[tuple[Fault, Random]]:
        return [(f, r) for f, r in zip(self._faults, self._random, strict=True) if f.device == device]
