"""The ways in which a chat with the stand-in goes, by name; a sequence such as `busy,busy,ok` is gone through once, its
last entry stays."""

from threading import Lock

SCENARIOS: dict[str, str] = {
    "ok": "answers",
    "missing": "404: the model was never pulled",
    "busy": "503: its queue is full",
    "html": "502 with a page of HTML, as a proxy in front of it sends",
    "oom": "500: the model's process has ended",
    "bad_request": "400: it does not like what was asked",
    "too_long": "400: the prompt is longer than the context",
    "bad_json": "200 with a body that is no JSON",
    "no_message": "200 with JSON that lacks what the protocol has",
    "drop_before": "the connection ends before the answer",
    "drop_mid": "the connection ends in the middle of the answer",
    "error_mid": "an error in the middle of the answer",
    "hang": "nothing comes for as long as the client waits",
    "hang_mid": "the answer begins and does not go on",
    "dribble": "one byte at a time, without end, so that no read ever times out",
    "repeat": "the server stops a model that repeats itself: no `done`, no counts",
    "runaway": "the model goes on and on, whatever num_predict says",
    "length": "the answer is cut at num_predict",
    "think_only": "the whole answer stands in `thinking`",
    "think_empty": "it has thought, and then says nothing",
    "empty": "an empty answer",
    "truncated": "the prompt was cut to half of a window that it did not fit into; nothing tells but the count",
    "off_schema": "JSON that is not what the schema wants",
}


class Sequence:
    """Which scenario the next chat has."""

    def __init__(self, text: str) -> None:
        """Raises ValueError with one sentence."""
        names = [name.strip() for name in text.split(",") if name.strip()]
        unknown = [name for name in names if name not in SCENARIOS]
        if unknown or not names:
            raise ValueError(f"no scenario {', '.join(unknown) or 'is named'}; there are {', '.join(SCENARIOS)}")
        self._names, self._at, self._lock = names, 0, Lock()

    def next(self) -> str:
        with self._lock:
            name = self._names[min(self._at, len(self._names) - 1)]
            self._at += 1
            return name
