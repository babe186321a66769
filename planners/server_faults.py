"""What goes wrong between here and a model server: each kind of failure once, as an outcome and a sentence."""

import httpx

from planners.reply_checks import Fault

NOT_THE_PROTOCOL = (ValueError, TypeError, AttributeError, RecursionError)
"""What the client raises over bodies that are JSON of another shape, or none; ValueError is also pydantic's."""
FAULTS = (ConnectionError, TimeoutError, httpx.HTTPError, httpx.InvalidURL, *NOT_THE_PROTOCOL)
_SHOWN = 200
_NO_ROOM = ("longer than the context", "exceeds the available context", "context length", "input length exceeds")


class CannotSee(ValueError):
    """Pictures for a model that takes none."""


def fault_in(error: BaseException, model: str, host: str, limit_s: float) -> Fault:
    """One of FAULTS."""
    if isinstance(error, CannotSee):
        why = "it cannot look at pictures: choose a model with the capability `vision`"
        return Fault("refused", why, again=False)
    if isinstance(error, ConnectionError | httpx.ConnectError | httpx.ConnectTimeout | httpx.InvalidURL):
        return Fault("unreachable", f"no model server answers at {host}: `ollama serve` starts one there", again=False)
    if isinstance(error, TimeoutError | httpx.TimeoutException):
        return Fault("timeout", f"no whole answer within {limit_s:g} s", again=False)
    if isinstance(error, httpx.HTTPError):
        return Fault("broken", f"the connection to the model server ended in the middle ({type(error).__name__})")
    return Fault("broken", f"what came is not the protocol of a model server: {_short(str(error))}")


def fault_of_status(status: int, text: str, model: str) -> Fault:
    """An answer that is an error. The status is -1 when it came in the middle of a stream."""
    said = _short(text)
    if status == 404:
        return Fault("unreachable", f"the model server does not have it: `ollama pull {model}` fetches it", again=False)
    if status == 503:
        return Fault("busy", "the model server has too many requests waiting")
    if text.lstrip().startswith("<"):
        return Fault("broken", f"a page of HTML came with status {status}, not a model server's answer")
    if status == 400 and any(words in text for words in _NO_ROOM):
        return Fault("truncated", f"the prompt does not fit into its context: {said}", again=False)
    return Fault("refused", f"the model server answered with an error: {said}", again=status >= 500 or status < 0)


def _short(text: str) -> str:
    line = " ".join(str(text).split())
    return line if len(line) <= _SHOWN else f"{line[:_SHOWN]} ..."
