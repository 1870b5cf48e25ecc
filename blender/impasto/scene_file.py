"""The scene file of the painting, read and written through the program: a value that is written here is one field, and the rest of the
text stays as its owner wrote it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from . import binary

# What `impasto check` ends with where a scene has errors.
CHECK_FOUND_ERRORS = 3
# What was read last, by file, with the stamp of the file then.
_read: dict[Path, tuple[tuple[int, int], dict[str, Any]]] = {}


def _stamp(path: Path) -> tuple[int, int]:
    found = path.stat()
    return found.st_mtime_ns, found.st_size


def document(path: Path) -> dict[str, Any]:
    """The scene as a dictionary; empty where there is no file, or where it cannot be read."""
    try:
        stamp = _stamp(path)
    except OSError:
        return {}
    known = _read.get(path)
    if known is not None and known[0] == stamp:
        return known[1]
    from .failure import Failure

    try:
        found = json.loads(binary.run(["set", str(path), "--json"], timeout_s=20))
    except (Failure, json.JSONDecodeError):
        found = {}
    _read[path] = (stamp, found)
    return found


def sidecar(path: Path) -> dict[str, Any]:
    """What the sidecar of the shot, or another JSON file beside it, says; empty where it cannot be read."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, json.JSONDecodeError):
        return {}


def write(path: Path, values: list[str]) -> None:
    """Writes values, each as PATH=VALUE. Raises Failure with the words of the program; then the file is as it was."""
    binary.run(["set", str(path), *values], timeout_s=20)


def text(value: str) -> str:
    """A text as the scene file has it."""
    return json.dumps(value, ensure_ascii=False)


def number(value: float) -> str:
    """A number as a person would write it."""
    return f"{round(value, 4):g}"


def region_of(found: dict[str, Any], on: dict[str, Any]) -> int | None:
    """The index of the first region that covers exactly this."""
    for index, region in enumerate(found.get("regions", [])):
        if region.get("on") == on:
            return index
    return None


# Where regions overlap the last one counts, so the wider ones come first.
_ORDER = ("Everything", "Collection", "EachMaterial", "Object", "Material", "Group", "Dabs")


def _rank(on: Any) -> int:
    kind = on if isinstance(on, str) else next(iter(on), "")
    return _ORDER.index(kind) if kind in _ORDER else len(_ORDER)


def new_region(found: dict[str, Any], on: dict[str, Any], says: str) -> str:
    """The value that adds a region: behind those that cover more, and before those that cover less."""
    [(kind, of)] = on.items()
    regions = found.get("regions", [])
    behind = next((index for index, row in enumerate(regions) if _rank(row.get("on")) > _rank(on)), None)
    place = "regions" if behind is None else f"regions[{behind}]"
    return f"{place}+=(name: {text(free_name(found, of))}, on: {kind}({text(of)}), {says})"


def problems(path: Path) -> list[str]:
    """What the program finds in the scene and its shot, a line for each. Raises Failure."""
    said = binary.run(["check", "--json", str(path)], timeout_s=60, good=(0, CHECK_FOUND_ERRORS))
    return [_in_words(json.loads(line), path.parent) for line in said.splitlines()]


def _in_words(problem: dict[str, Any], folder: Path) -> str:
    """A problem as the program prints it, with its file as seen from the painting's folder."""
    place = [str(problem[part]) for part in ("line", "column") if problem.get(part) is not None]
    where = ":".join([problem["path"].removeprefix(f"{folder}/"), *place])
    mend = f"; {problem['mend']}" if problem.get("mend") else ""
    return f"{where}: {problem['severity']}: {problem['message']}{mend}"


def free_name(found: dict[str, Any], wanted: str) -> str:
    """A name for a region that no other has."""
    taken = {region.get("name") for region in found.get("regions", [])}
    if wanted not in taken:
        return wanted
    number_ = next(number_ for number_ in range(2, len(taken) + 3) if f"{wanted} {number_}" not in taken)
    return f"{wanted} {number_}"
