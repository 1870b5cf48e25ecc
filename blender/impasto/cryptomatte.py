"""Metadata of Cryptomatte: Blender's node finds a matte by the name of its view layer, and things by their names."""

from __future__ import annotations

import bpy

_MASK = 0xFFFFFFFF


def _rotated(value: int, by: int) -> int:
    return ((value << by) | (value >> (32 - by))) & _MASK


def murmur3(text: str) -> int:
    """MurmurHash3 (x86, 32 bits, seed 0) of the UTF-8 bytes of a text, as Cryptomatte 1.2 asks for."""
    data = text.encode("utf-8")
    found = 0
    whole = len(data) - len(data) % 4
    for at in range(0, whole, 4):
        part = int.from_bytes(data[at : at + 4], "little") * 0xCC9E2D51 & _MASK
        found = _rotated(found ^ (_rotated(part, 15) * 0x1B873593 & _MASK), 13)
        found = (found * 5 + 0xE6546B64) & _MASK
    if whole < len(data):
        part = int.from_bytes(data[whole:], "little") * 0xCC9E2D51 & _MASK
        found ^= _rotated(part, 15) * 0x1B873593 & _MASK
    found ^= len(data)
    found = (found ^ (found >> 16)) * 0x85EBCA6B & _MASK
    found = (found ^ (found >> 13)) * 0xC2B2AE35 & _MASK
    return found ^ (found >> 16)


def stamp(result: bpy.types.RenderResult, layer_name: str, notes: dict[str, str]) -> None:
    """Gives a result the Cryptomatte metadata of our file, under Blender's names: they begin with the view layer's."""
    for key, kind in notes.items():
        if not key.startswith("cryptomatte/") or not key.endswith("/name"):
            continue
        own = key.removesuffix("/name")
        name = f"{layer_name}.{kind}"
        theirs = f"cryptomatte/{murmur3(name):08x}"[: len("cryptomatte/") + 7]
        result.stamp_data_add_field(f"{theirs}/name", name)
        for field in ("hash", "conversion", "manifest"):
            result.stamp_data_add_field(f"{theirs}/{field}", notes.get(f"{own}/{field}", ""))
