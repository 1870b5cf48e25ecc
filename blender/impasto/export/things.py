"""What shows in a shot: objects and instances, where they are in each frame, and which of them bend."""

from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np

from .errors import ExportError
from .matrices import of_mesh
from .point_caches import PointCacheFile
from .shapes import Shape, place_of_points, points_of_corners

Key = tuple[object, ...]
# Points that move less than this part of the object's size stand still.
STILL = 1e-6


@dataclass
class Thing:
    """An object or instance that becomes a node."""

    name: str
    # Names of the objects whose collections it belongs to.
    owners: tuple[str, ...]
    # By the frame's place in the shot; no entry where it does not show.
    world_from_object: dict[int, np.ndarray] = field(default_factory=dict)

    def matrices(self, frames: int) -> np.ndarray:
        """A matrix for every frame; where it does not show, that of the last frame in which it did, or the first."""
        shown = np.array(sorted(self.world_from_object))
        held = shown[np.maximum(np.searchsorted(shown, np.arange(frames), side="right") - 1, 0)]
        return np.stack([self.world_from_object[place] for place in held.tolist()])

    def shows(self, frames: int) -> list[bool]:
        """Whether it shows, for every frame."""
        return [place in self.world_from_object for place in range(frames)]


@dataclass
class Body(Thing):
    """A thing with a mesh."""

    shape: Shape | None = None
    can_bend: bool = False
    cache: PointCacheFile | None = None
    cache_name: str = ""

    def write_until(self, frame_place: int, path: Path, frames: tuple[int, int]) -> None:
        """Begins a point cache with all frames before `frame_place`, in which the body moved but did not bend."""
        assert self.shape is not None
        self.cache = PointCacheFile(path, len(self.shape.places), frames)
        if frame_place == 0:
            return
        matrices = self.matrices(frame_place)
        for place in range(frame_place):
            if place > 0 and np.array_equal(matrices[place], matrices[place - 1]):
                self.cache.repeat()
            else:
                self.cache.add(world_places(self.shape.places, matrices[place]))


@dataclass
class Lamp(Thing):
    """A light; what it is in each frame."""

    kind: str = "POINT"
    states: dict[int, dict[str, object]] = field(default_factory=dict)


def world_places(places: np.ndarray, world_from_object: np.ndarray) -> np.ndarray:
    """Places in the world, Y up, of points of an object, Z up."""
    linear = world_from_object[:3, :3].astype(np.float32)
    moved = places @ linear.T + world_from_object[:3, 3].astype(np.float32)
    result = np.empty_like(moved)
    result[:, 0], result[:, 1], result[:, 2] = moved[:, 0], moved[:, 2], -moved[:, 1]
    return result


def y_up_matrices(body: Body, frames: int) -> np.ndarray:
    """The world matrices of a body for geometry that is Y up."""
    return of_mesh(body.matrices(frames))


def can_bend(thing: bpy.types.Object, is_made_by_nodes: bool) -> bool:
    """Whether an object's points may move within it."""
    original = thing.original
    if original is None or original.type != "MESH" or is_made_by_nodes or len(original.modifiers) > 0:
        return True
    data = original.data
    return data.shape_keys is not None or data.animation_data is not None or len(original.particle_systems) > 0


class Pose:
    """The points of a mesh in one frame, compared with those of a shape."""

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        self.counts = (len(mesh.vertices), len(mesh.polygons), len(mesh.loops))
        self.places = place_of_points(mesh)
        self.point_of_corner = points_of_corners(mesh)
        self._moved: dict[int, bool] = {}

    def check(self, shape: Shape, name: str, frame: int) -> None:
        """Raises an error where the mesh is no longer made of the same points and faces."""
        if self.counts[0] != shape.points:
            raise ExportError(
                f'"{name}" has {shape.points} points in frame {shape.first_frame} and {self.counts[0]} in frame {frame}: '
                "its mesh must keep its points; apply or turn off what adds points (Remesh, Fluid …)")
        if self.counts[1] != shape.faces or self.counts[2] != len(shape.point_of_corner):
            raise ExportError(
                f'"{name}" has {shape.faces} faces in frame {shape.first_frame} and {self.counts[1]} in frame {frame}: '
                "its mesh must keep its faces; apply or turn off what makes new ones (Remesh, Decimate …)")
        if not np.array_equal(self.point_of_corner, shape.point_of_corner):
            raise ExportError(
                f'"{name}" joins its points to other faces in frame {frame} than in frame {shape.first_frame}: '
                "its mesh must keep its faces; apply or turn off what makes new ones (Remesh, Decimate …)")

    def used(self, shape: Shape) -> np.ndarray:
        """The places of the points that the shape uses."""
        return self.places if shape.used_points is None else self.places[shape.used_points]

    def has_moved(self, shape: Shape) -> bool:
        """Whether points are elsewhere in the object than in the shape's first frame."""
        if id(shape) not in self._moved:
            used = self.used(shape)
            moved = not np.array_equal(used, shape.places)
            if moved:
                size = float(np.abs(shape.places).max(initial=0.0))
                moved = not bool(np.abs(used - shape.places).max() <= STILL * max(size, 1e-6))
            self._moved[id(shape)] = moved
        return self._moved[id(shape)]
