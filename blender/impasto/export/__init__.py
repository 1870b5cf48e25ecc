"""Writes a shot as Impasto reads it: a GLB, point caches, and a sidecar."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np

from .errors import ExportError, Stopped
from .glb import Glb
from .inputs_sum import sum_of_inputs
from .materials import MaterialTable
from .nodes import NodeWriter, write_body
from .sidecar import sidecar_of, write_sidecar
from .tracks import Tracks
from .walking import Walk

__all__ = ["ExportError", "ExportReport", "Stopped", "export_shot", "sum_of_inputs"]

# How much of the time the walk through the frames takes, more or less.
WALK_SHARE = 0.9


@dataclass
class ExportReport:
    """What was written."""

    frames: int
    objects: int
    cached_points: int
    # What could not be carried, by name.
    warnings: list[str] = field(default_factory=list)


def export_shot(walk: Callable[[int], bpy.types.Depsgraph], scene: bpy.types.Scene, folder: Path, *,
                frames: tuple[int, int], report: Callable[[float], None], stop: Callable[[], bool]) -> ExportReport:
    """Writes `shot.glb`, `caches/*.pc2` and `shot.impasto.json` into `folder`.

    `walk` goes to a frame and gives its evaluated depsgraph; it is called once for each frame, in order. Raises
    `ExportError` where the shot cannot be carried and `Stopped` where `stop` says so; what a former export wrote then
    stays as it was.
    """
    first, last = int(frames[0]), int(frames[-1])
    if last < first:
        raise ExportError(f'The scene "{scene.name}" ends in frame {last}, before it begins in frame {first}: '
                          "set its frame range.")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    glb = Glb(f"Impasto for Blender {bpy.app.version_string}")
    met = Walk(scene, (first, last), folder, MaterialTable(glb, []))
    try:
        inputs_sum = _see_all(met, walk, report, stop)
        tracks = Tracks(glb, np.arange(first, last + 1) * (scene.render.fps_base / scene.render.fps))
        _write_nodes(met, NodeWriter(glb, tracks, last - first + 1), stop)
        tracks.finish()
        report(0.95)
        glb.check_size()
        _finish_caches(met, folder)
        glb.write(folder / "shot.glb")
        write_sidecar(sidecar_of(met, inputs_sum), folder / "shot.impasto.json")
    finally:
        met.drop()
        (folder / "shot.glb.part").unlink(missing_ok=True)
    report(1.0)
    cached = sum(len(body.shape.places) for body in met.bodies.values() if body.cache is not None and body.shape)
    shown = sum(1 for body in met.bodies.values() if body.shape is not None)
    return ExportReport(last - first + 1, shown, cached, met.table.warnings)


def _see_all(met: Walk, walk: Callable[[int], bpy.types.Depsgraph], report: Callable[[float], None],
             stop: Callable[[], bool]) -> str:
    """Walks through all frames. Returns the checksum of what the shot is made of."""
    first, last = met.frames
    inputs_sum = ""
    for frame in range(first, last + 1):
        if stop():
            raise Stopped("The export was stopped.")
        graph = walk(frame)
        if frame == first:
            inputs_sum = sum_of_inputs(met.scene, graph.view_layer, met.frames)
        met.see(graph, frame, stop)
        report(WALK_SHARE * (frame + 1 - first) / (last + 1 - first))
    return inputs_sum


def _write_nodes(met: Walk, writer: NodeWriter, stop: Callable[[], bool]) -> None:
    frames = met.frames[1] - met.frames[0] + 1
    for camera in met.cameras.all:
        writer.camera(camera)
    for lamp in met.lamps.values():
        writer.lamp(lamp)
    for body in met.bodies.values():
        if stop():
            raise Stopped("The export was stopped.")
        if body.shape is None or not body.world_from_object:
            continue
        if body.cache is None and write_body(writer, body, frames):
            continue
        if body.cache is None:
            # Sheared: no node can say where it is, so its points do.
            met.begin_cache(body, frames)
        writer.bending_body(body)


def _finish_caches(met: Walk, folder: Path) -> None:
    """Gives the caches their names and removes those of a former export."""
    kept = set()
    for body in met.bodies.values():
        if body.cache is not None:
            body.cache.finish()
            kept.add(body.cache.path.name)
    for path in (folder / "caches").glob("*.pc2"):
        if path.name not in kept:
            path.unlink()
