"""Goes through the frames of a shot once and notes what shows, where it is, and how it bends."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np

from . import cameras, lights
from .errors import Stopped
from .materials import MaterialTable
from .names import Names, key_of
from .point_caches import safe_file_name
from .shapes import Shape, read_shape
from .things import Body, Key, Lamp, Pose, Thing, can_bend, world_places

# How many objects are read between two looks at whether the user wants to stop.
OBJECTS_PER_LOOK = 16


class Walk:
    """What was met on the way through the frames."""

    def __init__(self, scene: bpy.types.Scene, frames: tuple[int, int], folder: Path, table: MaterialTable) -> None:
        self.scene, self.frames, self.folder = scene, frames, folder
        self.bodies: dict[Key, Body] = {}
        self.lamps: dict[Key, Lamp] = {}
        self.cameras = cameras.Cameras(scene, frames, table.warnings)
        self.table = table
        self._names = Names()
        self._shapes: dict[Key, Shape | None] = {}
        self._file_names: set[str] = set()
        self._frame = frames[0]
        self._poses: dict[int, Pose] = {}

    @property
    def place(self) -> int:
        """The place of the frame in the shot, from 0 on."""
        return self._frame - self.frames[0]

    def see(self, graph: bpy.types.Depsgraph, frame: int, stop: Callable[[], bool]) -> None:
        """Notes one frame. The frames come in order, without gaps."""
        self._frame = frame
        self._poses.clear()
        is_viewport = graph.mode != "RENDER"
        hidden = _hidden_by_collections(graph) if is_viewport else set()
        for count, instance in enumerate(graph.object_instances):
            if count % OBJECTS_PER_LOOK == 0 and stop():
                raise Stopped("The export was stopped.")
            thing = instance.object
            if not instance.show_self or thing.type not in ("MESH", "LIGHT"):
                continue
            if is_viewport and _is_hidden(instance, hidden):
                continue
            if thing.type == "LIGHT":
                self._see_lamp(instance)
            elif thing.visible_camera and isinstance(thing.data, bpy.types.Mesh) and len(thing.data.polygons) > 0:
                self._see_body(instance)
        self.cameras.see(graph, self.place)
        for body in self.bodies.values():
            if body.cache is not None and body.cache.written <= self.place:
                body.cache.repeat()

    def _see_lamp(self, instance: bpy.types.DepsgraphObjectInstance) -> None:
        key = key_of(instance)
        lamp = self.lamps.get(key)
        if lamp is None:
            lamp = Lamp(self._names.of(instance), owners_of(instance), kind=instance.object.data.type)
            self.lamps[key] = lamp
        self._note_place(lamp, instance)
        lamp.states[self.place] = lights.state_of(instance.object.data, lamp.world_from_object[self.place])

    def _note_place(self, thing: Thing, instance: bpy.types.DepsgraphObjectInstance) -> None:
        matrix = np.array(instance.matrix_world, dtype=np.float64)
        before = thing.world_from_object.get(self.place - 1)
        thing.world_from_object[self.place] = before if before is not None and np.array_equal(before, matrix) else matrix

    def _see_body(self, instance: bpy.types.DepsgraphObjectInstance) -> None:
        key = key_of(instance)
        body = self.bodies.get(key)
        if body is not None and not body.can_bend:
            if body.shape is not None:
                self._note_place(body, instance)
            return
        thing = instance.object
        # What nodes or curves made has no object to make a mesh of: its data are the mesh.
        mesh = thing.data if instance.is_instance else thing.to_mesh()
        if body is None:
            body = self._new_body(instance, mesh)
            self.bodies[key] = body
        if body.shape is not None:
            if body.can_bend:
                self._bend(body, instance, mesh)
            self._note_place(body, instance)
        if not instance.is_instance:
            thing.to_mesh_clear()

    def _new_body(self, instance: bpy.types.DepsgraphObjectInstance, mesh: bpy.types.Mesh) -> Body:
        thing = instance.object
        original = thing.original
        is_made = instance.is_instance and (thing.data.original is None or original.type != "MESH"
                                            or thing.data.original != original.data)
        bends = can_bend(thing, is_made)
        worn = tuple(slot.material.name_full if slot.material and slot.link == "OBJECT" else "" for slot in thing.material_slots)
        group_names = tuple(group.name for group in original.vertex_groups) if original is not None else ()
        if bends:
            shape_key: Key = (self._frame, thing.data.as_pointer(), worn, group_names)
        else:
            shape_key = ("still", original.data.name_full, worn, group_names)
        if shape_key not in self._shapes:
            self._shapes[shape_key] = read_shape(thing, mesh, self.table, self._frame)
        return Body(self._names.of(instance), owners_of(instance), shape=self._shapes[shape_key], can_bend=bends)

    def _bend(self, body: Body, instance: bpy.types.DepsgraphObjectInstance, mesh: bpy.types.Mesh) -> None:
        """Notes how the body bends in this frame."""
        shape, pointer = body.shape, instance.object.data.as_pointer()
        assert shape is not None
        if self._frame == shape.first_frame:
            return
        pose = self._poses.get(pointer)
        if pose is None:
            pose = self._poses[pointer] = Pose(mesh)
        pose.check(shape, body.name, self._frame)
        if body.cache is None and pose.has_moved(shape):
            self.begin_cache(body, self.place)
        if body.cache is not None:
            body.cache.add(world_places(pose.used(shape), np.array(instance.matrix_world, dtype=np.float64)))

    def begin_cache(self, body: Body, frame_place: int) -> None:
        """Begins a point cache for a body, with its places in the frames before `frame_place`."""
        body.cache_name = safe_file_name(body.name, self._file_names)
        body.write_until(frame_place, self.folder / "caches" / f"{body.cache_name}.pc2", self.frames)

    def drop(self) -> None:
        """Removes the caches that are not finished."""
        for body in self.bodies.values():
            if body.cache is not None:
                body.cache.drop()


def owners_of(instance: bpy.types.DepsgraphObjectInstance) -> tuple[str, ...]:
    """The objects whose collections an instance belongs to."""
    owners = [instance.object.original, instance.parent.original if instance.is_instance and instance.parent else None]
    return tuple(dict.fromkeys(owner.name_full for owner in owners if owner is not None))


def _is_hidden(instance: bpy.types.DepsgraphObjectInstance, hidden: set[str]) -> bool:
    """Whether something that a depsgraph for the viewport shows is hidden from renders."""
    things = [instance.object] + ([instance.parent] if instance.is_instance and instance.parent else [])
    return any(thing.hide_render or thing.name_full in hidden for thing in things)


def _hidden_by_collections(graph: bpy.types.Depsgraph) -> set[str]:
    """Objects of the view layer that are only in collections that do not render."""
    rendered: set[str] = set()
    layers = [(graph.view_layer_eval.layer_collection, True)]
    while layers:
        layer, is_shown = layers.pop()
        is_shown = is_shown and not layer.collection.hide_render
        if is_shown and not layer.exclude:
            rendered.update(thing.name_full for thing in layer.collection.objects)
        layers += [(child, is_shown) for child in layer.children]
    return {thing.name_full for thing in graph.view_layer_eval.objects} - rendered
