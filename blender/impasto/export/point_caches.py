"""Point caches (PC2): places of points in the world, frame after frame."""

import os
import re
import struct
from pathlib import Path

import numpy as np

_RESERVED = {"con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in range(1, 10))}


class PointCacheFile:
    """One cache while it grows. It stands under a temporary name until `finish`."""

    def __init__(self, path: Path, points: int, frames: tuple[int, int]) -> None:
        self.path, self._part = path, path.with_name(path.name + ".part")
        self._samples = frames[1] - frames[0] + 1
        self.written = 0
        self._last = b""
        path.parent.mkdir(parents=True, exist_ok=True)
        header = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, points, float(frames[0]), 1.0, self._samples)
        self._part.write_bytes(header)

    def add(self, places: np.ndarray) -> None:
        """The next frame's places."""
        self._last = np.ascontiguousarray(places, dtype="<f4").tobytes()
        self._append()

    def repeat(self) -> None:
        """The next frame is as the last."""
        self._append()

    def _append(self) -> None:
        # Opened anew each time: a shot may have more caches than a system lets stand open.
        with open(self._part, "ab", buffering=0) as file:
            file.write(self._last)
        self.written += 1

    def finish(self) -> None:
        """Gives the file its name."""
        assert self.written == self._samples, f"{self.path.name}: {self.written} of {self._samples} frames"
        os.replace(self._part, self.path)

    def drop(self) -> None:
        """Removes what was written."""
        self._part.unlink(missing_ok=True)


def safe_file_name(name: str, taken: set[str]) -> str:
    """A file name without ending for an object's name, on every system; added to `taken`."""
    plain = re.sub(r'[<>:"/\\|?*\x00-\x1f]', "_", name).strip(" .")[:80] or "object"
    if plain.split(".")[0].lower() in _RESERVED:
        plain = "_" + plain
    result, number = plain, 1
    while result.lower() in taken:
        result = f"{plain}.{number:03}"
        number += 1
    taken.add(result.lower())
    return result
