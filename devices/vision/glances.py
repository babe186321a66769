"""One camera's conversation with a vision model: when to ask, what came of it, what of it is worth a line in the log.

Never more than one question is open, and none is waited for: whoever drives this goes on with what else it does.
"""

import logging
from collections import deque
from dataclasses import dataclass, replace

from devices.vision.gridmask import grid_for
from devices.vision.lens import Lens
from devices.vision.model_eyes import question
from devices.vision.picture import PictureError, decode_frame
from devices.vision.prompt import Duty, room_duty
from devices.vision.reply import ReplyError, Report, read
from devices.vision.steady import Cells, alike, cells_of
from wire.bus import Reply
from wire.messages.driver import CameraFrame
from wire.messages.look import LookReply, LookRequest

log = logging.getLogger("glances")

LONGEST_PAUSE_S = 300.0
"""A model that fails is asked ever less often, down to this."""
ANSWERS_FOR_ONE_VIEW = 2
"""A second answer about the same view confirms the first. After that a still picture is asked about seldom."""
STILL_PAUSES = 10
LINES_A_MINUTE = 6
SAID_LATELY_S = 600.0


@dataclass(frozen=True)
class Glance:
    """An answer, and the picture that it is about."""

    report: Report
    lens: Lens
    stamp_s: float
    stand_in: bool = False


@dataclass(frozen=True)
class _View:
    lens: Lens
    stamp_s: float
    cells: Cells


class Glances:
    """See above. Times are seconds on the mesh's clock."""

    def __init__(self, asker: str, every_s: float, duty: Duty | None = None) -> None:
        self._asker, self._every_s, self._duty = asker, every_s, duty or room_duty()
        self._open: tuple[int, _View] | None = None
        self._unnumbered: _View | None = None
        self._next_s = 0.0
        self._fails = self._asked = 0
        self._answered: _View | None = None
        self._answers = self._still = 0
        self._last: Glance | None = None
        self._said: dict[str, float] = {}
        self._line_stamps: deque[float] = deque()
        self.trouble = ""
        """Why the last question had no answer; empty when it had."""

    def offer(self, now_s: float, frame: CameraFrame) -> LookRequest | Glance | None:
        """A question to be asked (`asked` is to be told its number); or the last answer, which still holds because the
        view is the same; or nothing, because it is too early."""
        if self._open is not None or now_s < self._next_s:
            return None
        try:
            picture = decode_frame(frame)
        except PictureError as error:
            log.warning("%s", error)
            return None
        view = _View(picture.lens, frame.stamp_s, cells_of(picture.rgb))
        self._next_s = now_s + self._every_s
        if self._holds(view) and self._last is not None:
            self._still += 1
            return replace(self._last, stamp_s=frame.stamp_s, report=replace(self._last.report, sentences=(), texts=()))
        self._unnumbered = view
        self._asked += 1
        return question(picture.rgb, picture.lens, self._asker, self._duty, seed=self._asked)

    def asked(self, number: int) -> None:
        """The question of the last `offer` has been sent under this number."""
        assert self._unnumbered is not None
        self._open, self._unnumbered = (number, self._unnumbered), None

    def hear(self, reply: Reply, now_s: float) -> Glance | None:
        """What an answer says, if it is one to the open question; `trouble` says why it is none."""
        if self._open is None or reply.ask != self._open[0]:
            return None
        view, self._open = self._open[1], None
        try:
            report = self._read(reply, view)
        except ReplyError as error:
            self._failed(str(error), now_s)
            return None
        for doubt in report.doubts:
            log.info("%s: %s", self._asker, doubt)
        self._answers = self._answers + 1 if self._same(view) else 1
        self._answered, self._still, self._fails, self.trouble = view, 0, 0, ""
        self._last = Glance(report, view.lens, view.stamp_s, _from_stand_in(reply))
        return self._last

    def lines(self, glance: Glance, now_s: float) -> list[str]:
        """What of the model's words goes into the event log: nothing twice in ten minutes, six lines a minute at most."""
        who = "the stand-in for a vision model" if glance.stand_in else "the vision model"
        wanted = [f"{who} says {s}" for s in glance.report.sentences]
        wanted += [f"{who} reads {t} in the picture" for t in glance.report.texts]
        while self._line_stamps and self._line_stamps[0] <= now_s - 60.0:
            self._line_stamps.popleft()
        self._said = {line: s for line, s in self._said.items() if s > now_s - SAID_LATELY_S}
        lines = []
        for line in wanted:
            if line not in self._said and len(self._line_stamps) < LINES_A_MINUTE:
                self._said[line] = now_s
                self._line_stamps.append(now_s)
                lines.append(line)
        return lines

    def _read(self, reply: Reply, view: _View) -> Report:
        said = reply.message
        if not isinstance(said, LookReply):
            raise ReplyError(reply.error)
        if not said.text:
            raise ReplyError(said.reason)
        return read(said.text, self._duty, grid_for(view.lens))

    def _failed(self, reason: str, now_s: float) -> None:
        self._fails += 1
        pause_s = min(self._every_s * 2.0 ** min(self._fails, 16), max(LONGEST_PAUSE_S, self._every_s))
        self._next_s = now_s + pause_s
        self.trouble = reason

    def _same(self, view: _View) -> bool:
        before = self._answered
        return before is not None and before.lens == view.lens and alike(before.cells, view.cells)

    def _holds(self, view: _View) -> bool:
        return self._same(view) and self._answers >= ANSWERS_FOR_ONE_VIEW and self._still < STILL_PAUSES


def _from_stand_in(reply: Reply) -> bool:
    said = reply.message
    return isinstance(said, LookReply) and said.call is not None and said.call.stand_in
