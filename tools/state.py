"""doit's record of what is finished."""

import sqlite3

from doit.dependency import SqliteDB


class DurableDB(SqliteDB):
    """doit's record of finished steps, written when a step ends rather than when the run ends.

    A build that is killed thus keeps the notebooks it had finished.
    """

    def _sqlite3(self, name: str) -> sqlite3.Connection:
        connection = super()._sqlite3(name)
        connection.execute("PRAGMA synchronous = OFF")
        return connection

    def set(self, task_id: str, dependency: str, value: object) -> None:
        """Store one value of a step."""
        super().set(task_id, dependency, value)
        row = (task_id, self.codec.encode(self._cache[task_id]))
        self._conn.execute("insert or replace into doit values (?, ?)", row)
        self._conn.commit()
