"""The file beside the GLB: what glTF has no words for."""

import json
import os
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from .cameras import picture_size
from .things import Thing
from .tracks import changes
from .walking import Walk
from .world import light_of


def sidecar_of(walk: Walk, inputs_sum: str) -> dict[str, Any]:
    """The content of the sidecar."""
    scene = walk.scene
    content = {
        "version": 1,
        "made_by": f"Blender {bpy.app.version_string}",
        "sum": inputs_sum,
        "fps": scene.render.fps / scene.render.fps_base,
        "frames": list(walk.frames),
        "size": list(picture_size(scene)),
        "cuts": [{"frame": frame, "camera": seen.name} for frame, seen in walk.cameras.cuts],
        "shifts": _shifts(walk),
        "caches": {body.name: f"caches/{body.cache_name}.pc2" for body in walk.bodies.values() if body.cache is not None},
        "collections": _collections([body for body in walk.bodies.values() if body.shape is not None]),
        "exposure_stops": scene.view_settings.exposure,
    }
    world = light_of(scene.world, walk.table.warnings)
    if world is not None:
        content["world"] = world
    content["warnings"] = walk.table.warnings
    return content


def _shifts(walk: Walk) -> dict[str, Any]:
    result = {}
    for camera in walk.cameras.all:
        shifts = np.array(camera.shifts)
        if np.abs(shifts).max(initial=0.0) > 1e-7:
            rows = shifts if changes(shifts) else shifts[:1]
            result[camera.name] = {"first": walk.frames[0], "ndc": rows.tolist()}
    return result


def _collections(things: list[Thing]) -> dict[str, list[str]]:
    """The names of the nodes in each collection, also in those within it."""
    collections_of: dict[str, list[str]] = {}
    for collection in bpy.data.collections:
        for thing in collection.all_objects:
            collections_of.setdefault(thing.name_full, []).append(collection.name)
    result: dict[str, list[str]] = {}
    for thing in things:
        names = dict.fromkeys(name for owner in thing.owners for name in collections_of.get(owner, []))
        for name in names:
            result.setdefault(name, []).append(thing.name)
    return dict(sorted(result.items()))


def write_sidecar(content: dict[str, Any], path: Path) -> None:
    """Writes the file, whole or not at all."""
    part = path.with_name(path.name + ".part")
    part.write_text(json.dumps(content, ensure_ascii=False, indent=1), encoding="utf-8")
    os.replace(part, path)
