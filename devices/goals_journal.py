"""What a device remembers of its goals: written before it is said, so that a restart neither forgets nor repeats."""

import sqlite3
from pathlib import Path

from wire.messages.command import Command, GoalRecord, GoalStatus, Result

KEPT_GOALS = 1000
"""Older finished goals are forgotten when the journal is opened."""

_OPEN = ("accepted", "running")


class GoalsJournal:
    """Goals in the order in which they were accepted, and the highest epoch of a hub seen."""

    def __init__(self, connection: sqlite3.Connection) -> None:
        self._db = connection
        self._db.execute(
            "CREATE TABLE IF NOT EXISTS goals (seq INTEGER PRIMARY KEY, goal_id TEXT UNIQUE NOT NULL,"
            " record TEXT NOT NULL, status TEXT NOT NULL, command TEXT NOT NULL)"
        )
        self._db.execute("CREATE TABLE IF NOT EXISTS epoch (only INTEGER PRIMARY KEY CHECK (only = 1), value INTEGER)")
        self._db.execute(
            "DELETE FROM goals WHERE seq <= (SELECT coalesce(max(seq), 0) FROM goals) - ? AND status NOT IN (?, ?)",
            (KEPT_GOALS, *_OPEN),
        )
        self._db.commit()

    @property
    def epoch(self) -> int:
        row = self._db.execute("SELECT value FROM epoch").fetchone()
        return int(row[0]) if row else 0

    def raise_epoch(self, epoch: int) -> None:
        """Remember a newer hub. Never goes back."""
        if epoch > self.epoch:
            self._db.execute("INSERT OR REPLACE INTO epoch VALUES (1, ?)", (epoch,))
            self._db.commit()

    def record(self, goal_id: str) -> GoalRecord | None:
        row = self._db.execute("SELECT record FROM goals WHERE goal_id = ?", (goal_id,)).fetchone()
        return GoalRecord.model_validate_json(row[0]) if row else None

    def accept(self, command: Command, status: GoalStatus) -> None:
        """A goal is taken on; raises sqlite3.IntegrityError when it is known already."""
        record = GoalRecord(goal_id=command.goal_id, status=status)
        self._db.execute(
            "INSERT INTO goals (goal_id, record, status, command) VALUES (?, ?, ?, ?)",
            (command.goal_id, record.model_dump_json(), status, command.model_dump_json()),
        )
        self._db.commit()

    def run(self, goal_id: str) -> None:
        self._write(GoalRecord(goal_id=goal_id, status="running"))

    def end(self, result: Result) -> None:
        self._write(
            GoalRecord(
                goal_id=result.goal_id,
                status=result.status,
                code=result.code,
                reason=result.reason,
                point_enu_m=result.point_enu_m,
            )
        )

    def open_goals(self) -> tuple[str, ...]:
        """Accepted or running: after a start, those that the last stop interrupted."""
        rows = self._db.execute("SELECT goal_id FROM goals WHERE status IN (?, ?) ORDER BY seq", _OPEN)
        return tuple(row[0] for row in rows)

    def records(self) -> tuple[GoalRecord, ...]:
        rows = self._db.execute("SELECT record FROM goals ORDER BY seq")
        return tuple(GoalRecord.model_validate_json(row[0]) for row in rows)

    def close(self) -> None:
        self._db.close()

    def _write(self, record: GoalRecord) -> None:
        self._db.execute(
            "UPDATE goals SET record = ?, status = ? WHERE goal_id = ?",
            (record.model_dump_json(), record.status, record.goal_id),
        )
        self._db.commit()


def open_journal(path: Path | None = None) -> GoalsJournal:
    """The journal in a file, each entry on the disk before the next line runs; in memory without a path."""
    if path is None:
        return GoalsJournal(sqlite3.connect(":memory:"))
    path.parent.mkdir(parents=True, exist_ok=True)
    connection = sqlite3.connect(path)
    connection.execute("PRAGMA journal_mode=WAL")
    connection.execute("PRAGMA synchronous=FULL")
    return GoalsJournal(connection)
