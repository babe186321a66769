"""The parameter table: values with their ranges and types; what is wrong with a write in one sentence."""

import math
from collections.abc import Iterable
from dataclasses import replace

from sim.autopilot.interface import Param


class Params:
    """One vehicle's parameters, in the order of their indices."""

    def __init__(self, rows: Iterable[Param], sysid: int) -> None:
        self._rows = {row.name: row for row in rows}
        for name in ("SYSID_THISMAV", "MAV_SYS_ID"):
            if name in self._rows:
                self._rows[name] = replace(self._rows[name], value=sysid, least=sysid, most=sysid)
        self._changed: dict[str, None] = {}

    def all(self) -> list[Param]:
        return list(self._rows.values())

    def has(self, name: str) -> bool:
        return name in self._rows

    def get(self, name: str, default: float | None = None) -> float:
        """The value. `KeyError` when this firmware has no such parameter and no default is given."""
        if default is not None and name not in self._rows:
            return default
        return self._rows[name].value

    def set(self, name: str, value: float) -> Param | str:
        """Write as a client: the parameter as it now is, or why not."""
        row = self._rows.get(name)
        if row is None:
            return f"There is no parameter {name}."
        if not math.isfinite(value):
            return f"{name} must be a number, not {value}."
        if row.read_only:
            return f"{name} is read-only and stays {row.value:g}."
        if row.integer and value != round(value):
            return f"{name} must be a whole number, not {value:g}."
        if not row.least <= value <= row.most:
            return f"{name} must lie from {row.least:g} to {row.most:g}, not {value:g}."
        self._rows[name] = replace(row, value=float(value))
        return self._rows[name]

    def put(self, name: str, value: float) -> None:
        """Write from inside; told by `changed` when it differs."""
        row = self._rows[name]
        if row.value != value:
            self._rows[name] = replace(row, value=float(value))
            self._changed[name] = None

    def changed(self) -> list[Param]:
        """What `put` changed since the last call."""
        names = list(self._changed)
        self._changed.clear()
        return [self._rows[name] for name in names]
