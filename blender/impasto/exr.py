"""Reads the EXR files that `impasto serve` hands over: one part, no compression, one row after the other."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from .failure import Failure

_MAGIC = 20000630
_TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}


class Planes:
    """The channels of a picture, rows from the bottom up as Blender has them."""

    def __init__(
        self, size_px: tuple[int, int], channels: dict[str, np.ndarray], notes: dict[str, str]
    ) -> None:
        self.size_px = size_px
        self.channels = channels
        # The text attributes of the header.
        self.notes = notes

    def flat(self, names: list[str]) -> np.ndarray | None:
        """The channels side by side, pixel after pixel, as 32-bit floats; None where one of them is missing."""
        if any(name not in self.channels for name in names):
            return None
        planes = [self.channels[name].astype(np.float32) for name in names]
        return np.stack(planes, axis=-1)


def read(path: Path) -> Planes:
    """Reads a file.

    Raises Failure where it is none of ours."""
    data = path.read_bytes()
    try:
        return _planes(data)
    except (struct.error, ValueError, KeyError, IndexError) as error:
        raise Failure(f"{path} is not as impasto writes it ({error}): render again.") from error


def _planes(data: bytes) -> Planes:
    if struct.unpack_from("<I", data)[0] != _MAGIC:
        raise ValueError("no EXR file")
    attributes, at = _attributes(data, 8)
    if attributes["compression"][1] != b"\0":
        raise ValueError("compressed")
    left, bottom, right, top = struct.unpack("<4i", attributes["dataWindow"][1])
    width, height = right - left + 1, top - bottom + 1
    names, types = _channel_list(attributes["channels"][1])
    row_type = np.dtype(
        [("y", "<i4"), ("bytes", "<i4")] + [(f"c{index}", kind, width) for index, kind in enumerate(types)]
    )
    # After the header comes the table of the rows' offsets, 8 bytes each; then the rows, in order.
    first = at + 8 * height
    rows = np.frombuffer(data, dtype=row_type, count=height, offset=first)
    if rows["bytes"][0] != row_type.itemsize - 8 or rows["y"][-1] != top:
        raise ValueError("odd rows")
    channels = {name: rows[f"c{index}"][::-1] for index, name in enumerate(names)}
    notes = {name: value.decode("utf-8", "replace") for name, (kind, value) in attributes.items() if kind == "string"}
    return Planes((width, height), channels, notes)


def _attributes(data: bytes, at: int) -> tuple[dict[str, tuple[str, bytes]], int]:
    """The attributes of the head, each with its type, and where it ends."""
    found: dict[str, tuple[str, bytes]] = {}
    while data[at] != 0:
        name, at = _text(data, at)
        kind, at = _text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        found[name] = (kind, data[at + 4 : at + 4 + size])
        at += 4 + size
    return found, at + 1


def _text(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode("utf-8", "replace"), end + 1


def _channel_list(data: bytes) -> tuple[list[str], list[np.dtype]]:
    names: list[str] = []
    types: list[np.dtype] = []
    at = 0
    while data[at] != 0:
        name, at = _text(data, at)
        names.append(name)
        types.append(_TYPES[struct.unpack_from("<i", data, at)[0]])
        at += 16
    return names, types
