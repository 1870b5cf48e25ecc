# Reads the EXR files that Blender writes without compression: one part or several, rows one after the other. It shares
# nothing with the reader of the extension.
import struct

import numpy as np

TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}


def _header(data: bytes, at: int) -> tuple[dict[str, bytes], int]:
    attributes = {}
    while data[at]:
        end = data.index(b"\0", at)
        name, at = data[at:end].decode(), end + 1
        at = data.index(b"\0", at) + 1
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name], at = data[at + 4 : at + 4 + size], at + 4 + size
    return attributes, at + 1


def _channels(data: bytes) -> list[tuple[str, np.dtype]]:
    found, at = [], 0
    while data[at]:
        end = data.index(b"\0", at)
        found.append((data[at:end].decode(), TYPES[struct.unpack_from("<i", data, end + 1)[0]]))
        at = end + 17
    return found


def attributes(path: str) -> dict[str, bytes]:
    """The attributes of the first part."""
    with open(path, "rb") as file:
        return _header(file.read(), 8)[0]


def read(path: str) -> dict[str, np.ndarray]:
    """Every channel by its whole name, rows from the bottom up."""
    with open(path, "rb") as file:
        data = file.read()
    is_multipart = bool(struct.unpack_from("<I", data, 4)[0] & 0x1000)
    at, headers = 8, []
    while data[at]:
        attributes, at = _header(data, at)
        headers.append(attributes)
        if not is_multipart:
            break
    if is_multipart:
        at += 1
    found: dict[str, np.ndarray] = {}
    for header in headers:
        assert header["compression"] == b"\0", "written with compression"
        left, bottom, right, top = struct.unpack("<4i", header["dataWindow"])
        width, height = right - left + 1, top - bottom + 1
        channels = _channels(header["channels"])
        offsets = struct.unpack_from(f"<{height}Q", data, at)
        at += 8 * height
        planes = [np.empty((height, width), kind) for _, kind in channels]
        for offset in offsets:
            row = offset + 4 * is_multipart
            y, _size = struct.unpack_from("<2i", data, row)
            row += 8
            for plane, (_, kind) in zip(planes, channels):
                plane[top - y] = np.frombuffer(data, kind, width, row)
                row += width * kind.itemsize
        found.update({name: plane for (name, _), plane in zip(channels, planes)})
    return found
