"""Writes a GLB: JSON and one block of binary data, in which equal stretches are stored once."""

import hashlib
import json
import os
import struct
from pathlib import Path
from typing import Any

import numpy as np

from .errors import ExportError

# Impasto reads no larger file.
_MOST_BYTES = 2 << 30

COMPONENT_CODES = {np.dtype(np.float32): 5126, np.dtype(np.uint32): 5125, np.dtype(np.uint16): 5123,
                   np.dtype(np.uint8): 5121}
SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


class Glb:
    """A glTF document that grows by and by."""

    def __init__(self, generator: str) -> None:
        self.root: dict[str, Any] = {"asset": {"version": "2.0", "generator": generator}}
        self._chunks: list[bytes | memoryview] = []
        self._length = 0
        self._known: dict[tuple[str, bytes], int] = {}
        self._used: set[str] = set()

    def use(self, extension: str) -> None:
        """Lists an extension."""
        self._used.add(extension)

    def add(self, kind: str, item: dict[str, Any]) -> int:
        """Adds an item to one of the document's lists, such as `meshes`; returns its index."""
        items = self.root.setdefault(kind, [])
        items.append(item)
        return len(items) - 1

    def add_once(self, kind: str, item: dict[str, Any]) -> int:
        """As `add`, but what is there already is used again."""
        key = (kind, hashlib.blake2b(json.dumps(item, sort_keys=True).encode()).digest())
        if key not in self._known:
            self._known[key] = self.add(kind, item)
        return self._known[key]

    def view(self, content: bytes | memoryview, target: int | None = None) -> int:
        """A stretch of the binary block; the index of its buffer view."""
        key = (f"view {target}", hashlib.blake2b(content).digest())
        if key in self._known:
            return self._known[key]
        padding = -self._length % 4
        self._chunks += [b"\0" * padding, content]
        item = {"buffer": 0, "byteOffset": self._length + padding, "byteLength": len(content)}
        if target is not None:
            item["target"] = target
        self._length += padding + len(content)
        self._known[key] = self.add("bufferViews", item)
        return self._known[key]

    def numbers(self, values: np.ndarray, *, target: int | None = None, bounds: bool = False) -> int:
        """An accessor for rows of numbers; the index."""
        values = np.ascontiguousarray(values)
        width = 1 if values.ndim == 1 else values.shape[1]
        item: dict[str, Any] = {
            "bufferView": self.view(memoryview(values).cast("B"), target),
            "componentType": COMPONENT_CODES[values.dtype],
            "count": len(values),
            "type": SHAPES[width],
        }
        if bounds:
            rows = values.reshape(len(values), width)
            item["min"], item["max"] = rows.min(axis=0).tolist(), rows.max(axis=0).tolist()
        return self.add_once("accessors", item)

    def check_size(self) -> None:
        """Raises `ExportError` where the file would be larger than what can be read."""
        if self._length > _MOST_BYTES:
            raise ExportError(f"The shot has {self._length / 2**30:.1f} GiB, and at most 2 are read: "
                              "export fewer frames or objects.")

    def write(self, path: Path) -> None:
        """Writes the file, whole or not at all."""
        if self._used:
            self.root["extensionsUsed"] = sorted(self._used)
        padding = -self._length % 4
        if self._length:
            self.root["buffers"] = [{"byteLength": self._length}]
        text = json.dumps(self.root, ensure_ascii=False, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        binary = self._length + padding
        total = 12 + 8 + len(text) + (8 + binary if binary else 0)
        part = path.with_name(path.name + ".part")
        with open(part, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, total))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            if binary:
                file.write(struct.pack("<I4s", binary, b"BIN\0"))
                for chunk in self._chunks:
                    file.write(chunk)
                file.write(b"\0" * padding)
        os.replace(part, path)
