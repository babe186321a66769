"""The durable log: every decision before it takes effect, and what is needed to go on after a kill.

`log` only grows and holds no wall-clock time but how long models took: two equal runs write equal bytes. `state` holds
the newest of each key.
"""

import sqlite3
from pathlib import Path

_SCHEMA = """
CREATE TABLE IF NOT EXISTS log (n INTEGER PRIMARY KEY, stamp_s REAL NOT NULL, kind TEXT NOT NULL, body TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS state (key TEXT PRIMARY KEY, body TEXT NOT NULL);
"""


class Journal:
    """SQLite in write-ahead mode, every commit flushed to the disk."""

    def __init__(self, path: Path | None = None) -> None:
        """None keeps the journal in memory."""
        if path is not None:
            path.parent.mkdir(parents=True, exist_ok=True)
        self._db = sqlite3.connect(path or ":memory:", isolation_level=None)
        self._db.execute("PRAGMA journal_mode=WAL")
        self._db.execute("PRAGMA synchronous=FULL")
        self._db.executescript(_SCHEMA)

    def decide(self, stamp_s: float, kind: str, body: str, state: dict[str, str]) -> None:
        """One decision and the state after it, in one transaction."""
        self._db.execute("BEGIN")
        self._db.execute("INSERT INTO log (stamp_s, kind, body) VALUES (?, ?, ?)", (round(stamp_s, 6), kind, body))
        self._keep(state)
        self._db.execute("COMMIT")

    def keep(self, state: dict[str, str]) -> None:
        """State without a decision: snapshots."""
        self._db.execute("BEGIN")
        self._keep(state)
        self._db.execute("COMMIT")

    def _keep(self, state: dict[str, str]) -> None:
        self._db.executemany("INSERT OR REPLACE INTO state (key, body) VALUES (?, ?)", sorted(state.items()))

    def read(self, key: str) -> str | None:
        row = self._db.execute("SELECT body FROM state WHERE key = ?", (key,)).fetchone()
        return None if row is None else str(row[0])

    def log(self) -> list[tuple[float, str, str]]:
        """Every decision: (stamp_s, kind, body)."""
        return [
            (float(s), str(k), str(b)) for s, k, b in self._db.execute("SELECT stamp_s, kind, body FROM log ORDER BY n")
        ]

    def bodies(self, kind: str) -> list[tuple[float, str]]:
        """The decisions of one kind: (stamp_s, body)."""
        rows = self._db.execute("SELECT stamp_s, body FROM log WHERE kind = ? ORDER BY n", (kind,))
        return [(float(stamp_s), str(body)) for stamp_s, body in rows]

    def last_s(self) -> float:
        """Time of the last decision; 0 when there is none."""
        row = self._db.execute("SELECT stamp_s FROM log ORDER BY n DESC LIMIT 1").fetchone()
        return float(row[0]) if row is not None else 0.0

    def next_epoch(self) -> int:
        """Count this run of the hub; devices refuse what an earlier one says."""
        epoch = int(self.read("epoch") or "-1") + 1
        self.keep({"epoch": str(epoch)})
        return epoch

    def close(self) -> None:
        self._db.close()
