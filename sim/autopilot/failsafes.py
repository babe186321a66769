"""Failsafes: each alarm is announced once, and the most severe action wins over what is flown and what was begun."""

from dataclasses import dataclass, field

from sim.autopilot.alarms import Action, Watch, alarms, station_timeout_s
from sim.autopilot.interface import Severity
from sim.autopilot.situation import Situation

_SEVERITY_OF_MODE = {"return": Action.RETURN, "land": Action.LAND}
_DEEDS = {
    Action.HOLD: "holding position",
    Action.RETURN: "returning",
    Action.LAND: "landing",
    Action.TERMINATE: "terminating flight",
}


@dataclass(slots=True)
class Failsafes:
    """`look` often; what it returns is to be begun now."""

    watch: Watch = field(default_factory=Watch)
    engaged: Action = Action.NONE
    """What a failsafe has begun; the pilot who changes the mode takes over."""
    _raised: dict[str, Action] = field(default_factory=dict)
    _due: tuple[Action, float, str] | None = None

    @property
    def critical(self) -> bool:
        return self.engaged >= Action.HOLD or any(action >= Action.HOLD for action in self._raised.values())

    def armed(self, now: Situation, now_s: float) -> None:
        """A flight begins: what is wrong counts anew; a station that has long gone is not waited for."""
        self._raised.clear()
        self.taken_over()
        heard_s = self.watch.station_s
        if heard_s is not None and now_s - heard_s > station_timeout_s(now):
            self.watch.station_s = None

    def taken_over(self) -> None:
        """Somebody chose a mode, or the flight is over."""
        self.engaged, self._due = Action.NONE, None

    def look(self, now: Situation, now_s: float) -> Action:
        """The action to begin at this moment; NONE for none."""
        begin = Action.NONE
        standing: dict[str, Action] = {}
        for alarm in alarms(now, self.watch, now_s):
            if alarm.action is Action.NONE:
                continue
            standing[alarm.name] = alarm.action
            if alarm.action <= self._raised.get(alarm.name, Action.NONE):
                continue
            acts = now.armed and alarm.action >= Action.HOLD
            delay_s = now.params.get("COM_FAIL_ACT_T", 0.0) if alarm.patient and alarm.action > Action.HOLD else 0.0
            deed = f": {_DEEDS[alarm.action]}" if acts else ""
            now.say(Severity.CRITICAL if acts else Severity.WARNING, f"{alarm.text}{deed}")
            if acts and delay_s > 0.0:
                if self._due is None or alarm.action > self._due[0]:
                    self._due = (alarm.action, now_s + delay_s, alarm.name)
                begin = max(begin, Action.HOLD)
            elif acts:
                begin = max(begin, alarm.action)
        for name in self._raised.keys() - standing.keys():
            now.say(Severity.INFO, f"Over: {name} alarm")
        self._raised = standing
        if self._due is not None and self._due[2] not in standing:
            self._due = None
        if self._due is not None and now_s >= self._due[1]:
            begin, self._due = max(begin, self._due[0]), None
        if not now.armed or begin <= max(self.engaged, _SEVERITY_OF_MODE.get(now.mode, Action.NONE)):
            return Action.NONE
        self.engaged = begin
        return begin
