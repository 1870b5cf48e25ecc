"""Cameras: which one is cut to when, and what each sees."""

import math
from dataclasses import dataclass, field

import bpy
import numpy as np


@dataclass
class Camera:
    """A camera, frame by frame."""

    name: str
    is_perspective: bool
    world_from_object: list[np.ndarray] = field(default_factory=list)
    # Heights: yfov in radians, or ymag. Widths: tan(xfov / 2), or xmag. Clips: near and far. Shifts: in NDC.
    heights: list[float] = field(default_factory=list)
    widths: list[float] = field(default_factory=list)
    clips: list[tuple[float, float]] = field(default_factory=list)
    shifts: list[tuple[float, float]] = field(default_factory=list)


def picture_size(scene: bpy.types.Scene) -> tuple[int, int]:
    """Pixels of the picture."""
    render = scene.render
    percent = render.resolution_percentage
    return max(render.resolution_x * percent // 100, 1), max(render.resolution_y * percent // 100, 1)


def camera_of_frame(scene: bpy.types.Scene, frame: int) -> bpy.types.Object | None:
    """The camera of a frame: that of the last marker until then, else of the first marker, else the scene's."""
    markers = [marker for marker in scene.timeline_markers if marker.camera is not None and not marker.camera.hide_render]
    if not markers:
        return scene.camera
    past = [marker for marker in markers if marker.frame <= frame]
    if past:
        return max(past, key=lambda marker: marker.frame).camera
    return min(markers, key=lambda marker: marker.frame).camera


class Cameras:
    """The cameras of a shot: those that markers cut to, and the scene's."""

    def __init__(self, scene: bpy.types.Scene, frames: tuple[int, int], warnings: list[str]) -> None:
        self._scene, self._warnings = scene, warnings
        self.cuts: list[tuple[int, bpy.types.Object]] = []
        for frame in range(frames[0], frames[1] + 1):
            seen = camera_of_frame(scene, frame)
            if seen is not None and (not self.cuts or self.cuts[-1][1] != seen):
                self.cuts.append((frame, seen))
        bound = [seen for _, seen in self.cuts]
        bound += [marker.camera for marker in scene.timeline_markers if marker.camera is not None]
        bound += [scene.camera] if scene.camera is not None else []
        self._originals = list(dict.fromkeys(bound))
        self.all: list[Camera] = []
        for seen in self._originals:
            if seen.type != "CAMERA":
                warnings.append(f'"{seen.name}" is used as a camera and is none: give the scene a camera object.')
        self._originals = [seen for seen in self._originals if seen.type == "CAMERA"]
        self.cuts = [(frame, seen) for frame, seen in self.cuts if seen.type == "CAMERA"]
        for seen in self._originals:
            if seen.data.type not in ("PERSP", "ORTHO"):
                warnings.append(f'The camera "{seen.name}" is neither perspective nor orthographic: it is carried as '
                                "perspective; set its lens type.")
            if seen.data.dof.use_dof:
                warnings.append(f'The camera "{seen.name}" has depth of field, which is not painted.')
            self.all.append(Camera(seen.name, seen.data.type != "ORTHO"))
        if scene.render.use_motion_blur:
            warnings.append("Motion blur is not painted.")

    def see(self, graph: bpy.types.Depsgraph, place: int) -> None:
        """Notes one frame."""
        width, height = picture_size(self._scene)
        render = self._scene.render
        for camera, original in zip(self.all, self._originals):
            seen = original.evaluated_get(graph)
            matrix = np.array(seen.calc_matrix_camera(
                graph, x=width, y=height, scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y))
            camera.world_from_object.append(np.array(seen.matrix_world, dtype=np.float64))
            camera.clips.append((seen.data.clip_start, seen.data.clip_end))
            camera.widths.append(1.0 / matrix[0, 0])
            if camera.is_perspective:
                camera.heights.append(2.0 * math.atan(1.0 / matrix[1, 1]))
                camera.shifts.append((-float(matrix[0, 2]), -float(matrix[1, 2])))
            else:
                camera.heights.append(1.0 / matrix[1, 1])
                camera.shifts.append((float(matrix[0, 3]), float(matrix[1, 3])))
