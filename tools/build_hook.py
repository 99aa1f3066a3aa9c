"""Hook of hatchling: wheels and source archives keep the commit that they are made from, in `facegear/commit.txt`."""

import sys
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CommitHook(BuildHookInterface):
    """Leaves the file out where git cannot tell, as in an unpacked source archive, which has one already."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write the file elsewhere, not into the tree."""
        if version == "editable":
            return
        sys.path.insert(0, str(Path(self.root) / "facegear" / "support"))
        from provenance import COMMIT_FILE, commit_of  # alone: the package's dependencies are not here

        commit = commit_of(Path(self.root) / "facegear")
        if commit:
            path = Path(self.folder.name) / COMMIT_FILE
            path.write_text(commit + "\n", encoding="ascii")
            build_data["force_include"][str(path)] = f"facegear/{COMMIT_FILE}"

    @cached_property
    def folder(self) -> TemporaryDirectory[str]:
        """Where the file is until the archive is made."""
        return TemporaryDirectory()
