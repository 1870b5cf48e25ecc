"""Writes what was met on the walk as nodes of the glTF file."""

import math
from typing import Any

import numpy as np

from . import lights, matrices
from .cameras import Camera
from .glb import ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, Glb
from .shapes import Part, Shape
from .things import Body, Lamp, world_places, y_up_matrices
from .tracks import Tracks, changes


class NodeWriter:
    """Adds nodes to a file."""

    def __init__(self, glb: Glb, tracks: Tracks, frames: int) -> None:
        self._glb, self._tracks, self._frames = glb, tracks, frames
        glb.root.update({"scene": 0, "scenes": [{"nodes": []}]})

    def body(self, body: Body, parts: matrices.Parted) -> None:
        """An object that moves as a whole."""
        assert body.shape is not None
        mesh = body.shape.json_by_kind.get("own")
        if mesh is None:
            mesh = body.shape.json_by_kind["own"] = self._mesh(body.shape, None)
        node = self._node({"name": body.name, "mesh": mesh})
        self._place(node, parts, with_scale=True)
        self._tracks.visible(node, body.shows(self._frames))

    def bending_body(self, body: Body) -> None:
        """An object whose points come from a point cache. Its mesh is in world space, as it first shows."""
        assert body.shape is not None
        first = body.world_from_object[min(body.world_from_object)]
        node = self._node({"name": body.name, "mesh": self._mesh(body.shape, first)})
        self._tracks.visible(node, body.shows(self._frames))

    def camera(self, camera: Camera) -> None:
        """A camera."""
        near, far = camera.clips[0]
        if camera.is_perspective:
            lens = {"yfov": camera.heights[0], "znear": near, "zfar": far,
                    "aspectRatio": camera.widths[0] / math.tan(camera.heights[0] / 2.0)}
            item = {"name": camera.name, "type": "perspective", "perspective": lens}
            animated = [("yfov", camera.heights)]
        else:
            lens = {"xmag": camera.widths[0], "ymag": camera.heights[0], "znear": max(near, 0.0), "zfar": far}
            item = {"name": camera.name, "type": "orthographic", "orthographic": lens}
            animated = [("xmag", camera.widths), ("ymag", camera.heights)]
        index = self._glb.add("cameras", item)
        node = self._node({"name": camera.name, "camera": index})
        self._place(node, matrices.parted(matrices.of_looker(np.stack(camera.world_from_object))), with_scale=False)
        animated += [("znear", [clip[0] for clip in camera.clips]), ("zfar", [clip[1] for clip in camera.clips])]
        for name, values in animated:
            self._tracks.pointer(f"/cameras/{index}/{item['type']}/{name}", np.array(values))

    def lamp(self, lamp: Lamp) -> None:
        """A light."""
        shown = sorted(lamp.states)
        states = [lamp.states[max((place for place in shown if place <= at), default=shown[0])]
                  for at in range(self._frames)] if len(shown) < self._frames else [lamp.states[at] for at in shown]
        first = states[0]
        light: dict[str, Any] = {"name": lamp.name, "type": lights.KINDS[lamp.kind], "color": first["color"],
                                 "intensity": first["intensity"]}
        if "cones" in first:
            light["spot"] = {"innerConeAngle": first["cones"][0], "outerConeAngle": first["cones"][1]}
        self._glb.use("KHR_lights_punctual")
        holder = self._glb.root.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})
        holder["lights"].append(light)
        index = len(holder["lights"]) - 1
        item: dict[str, Any] = {"name": lamp.name, "extensions": {"KHR_lights_punctual": {"light": index}}}
        if "area" in first:
            item["extras"] = {"area": first["area"]}
        node = self._node(item)
        looking = matrices.of_looker(lamp.matrices(self._frames))
        self._place(node, matrices.parted(looking), with_scale=False)
        self._tracks.visible(node, lamp.shows(self._frames))
        pointer = f"/extensions/KHR_lights_punctual/lights/{index}"
        self._tracks.pointer(f"{pointer}/color", np.array([state["color"] for state in states]))
        self._tracks.pointer(f"{pointer}/intensity", np.array([state["intensity"] for state in states]))
        if lamp.kind == "SPOT":
            for order, name in enumerate(("innerConeAngle", "outerConeAngle")):
                self._tracks.pointer(f"{pointer}/spot/{name}", np.array([state["cones"][order] for state in states]))

    def _node(self, item: dict[str, Any]) -> int:
        node = self._glb.add("nodes", item)
        self._glb.root["scenes"][0]["nodes"].append(node)
        return node

    def _place(self, node: int, parts: matrices.Parted, *, with_scale: bool) -> None:
        """The node's place in the first frame, and how it changes."""
        values = {"translation": parts.translation, "rotation": parts.rotation_xyzw}
        if with_scale:
            values["scale"] = parts.scale
        plain = {"translation": [0.0] * 3, "rotation": [0.0, 0.0, 0.0, 1.0], "scale": [1.0] * 3}
        for path, rows in values.items():
            if changes(np.stack([rows[0], plain[path]])):
                self._glb.root["nodes"][node][path] = np.float32(rows[0]).tolist()
            self._tracks.node(node, path, rows)

    def _mesh(self, shape: Shape, world_from_object: np.ndarray | None) -> int:
        """A mesh in its own space or, for a point cache, in the world with `_POINT`: each vertex's row in the cache."""
        item: dict[str, Any] = {"primitives": [self._primitive(part, world_from_object) for part in shape.parts]}
        if shape.group_names:
            item["extras"] = {"groupNames": shape.group_names}
        return self._glb.add_once("meshes", item)

    def _primitive(self, part: Part, world_from_object: np.ndarray | None) -> dict[str, Any]:
        triangles, normals = part.triangles, part.normals
        if world_from_object is None:
            points = y_up(part.points)
        else:
            points = world_places(part.points, world_from_object)
            linear = world_from_object[:3, :3]
            if np.linalg.det(linear) < 0.0:
                triangles = triangles[:, ::-1]
            # The cofactors turn normals as the inverse transposed does, also where something is flat.
            cofactors = np.stack([np.cross(linear[(row + 1) % 3], linear[(row + 2) % 3]) for row in range(3)])
            normals = normals @ (cofactors * (-1.0 if np.linalg.det(linear) < 0.0 else 1.0)).T.astype(np.float32)
        attributes = {"POSITION": self._glb.numbers(points, target=ARRAY_BUFFER, bounds=True),
                      "NORMAL": self._glb.numbers(y_up(_unit(normals)), target=ARRAY_BUFFER)}
        further = {"TEXCOORD_0": part.uvs, "COLOR_0": part.colors, "_GROUP": part.groups}
        if world_from_object is not None:
            further["_POINT"] = part.row_of_vertex.astype(np.float32)
        for name, values in further.items():
            if values is not None:
                attributes[name] = self._glb.numbers(values, target=ARRAY_BUFFER)
        kind = np.uint16 if len(points) < 65535 else np.uint32
        indices = self._glb.numbers(triangles.astype(kind).ravel(), target=ELEMENT_ARRAY_BUFFER)
        return {"attributes": attributes, "indices": indices, "material": part.material}


def write_body(writer: NodeWriter, body: Body, frames: int) -> bool:
    """Writes a body without a point cache. Returns False, and writes nothing, where it is sheared and so needs one."""
    parts = matrices.parted(y_up_matrices(body, frames))
    if parts.is_sheared:
        return False
    writer.body(body, parts)
    return True


def y_up(vectors: np.ndarray) -> np.ndarray:
    """Points or directions of Blender with Y up."""
    result = np.empty(vectors.shape, dtype=np.float32)
    result[:, 0], result[:, 1], result[:, 2] = vectors[:, 0], vectors[:, 2], -vectors[:, 1]
    return result


def _unit(normals: np.ndarray) -> np.ndarray:
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    result = normals / np.where(lengths > 1e-12, lengths, 1.0)
    result[lengths[:, 0] <= 1e-12] = (0.0, 0.0, 1.0)
    return result
