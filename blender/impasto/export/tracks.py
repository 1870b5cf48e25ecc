"""Animation channels: only for what changes."""

from typing import Any

import numpy as np

from .glb import Glb

# Values that differ by no more than this are the same (relative to the first, where that is larger than 1).
TOLERANCE = 1e-6


class Tracks:
    """The one animation of the file."""

    def __init__(self, glb: Glb, times_s: np.ndarray) -> None:
        self._glb, self._times_s = glb, times_s
        self._samplers: list[dict[str, Any]] = []
        self._channels: list[dict[str, Any]] = []

    def node(self, node: int, path: str, values: np.ndarray) -> None:
        """A node's translation, rotation or scale, a row for each frame."""
        if changes(values):
            self._add(values.astype(np.float32), {"node": node, "path": path})

    def pointer(self, pointer: str, values: np.ndarray) -> None:
        """A property, a number or row for each frame."""
        if changes(values):
            self._add(values.astype(np.float32), _pointer_target(pointer))
            self._glb.use("KHR_animation_pointer")

    def visible(self, node: int, shows: list[bool]) -> None:
        """Whether a node shows, for each frame."""
        keys = [place for place, shown in enumerate(shows) if place == 0 or shown != shows[place - 1]]
        if len(keys) == 1 and shows[0]:
            return
        self._glb.root["nodes"][node].setdefault("extensions", {})["KHR_node_visibility"] = {"visible": shows[0]}
        self._glb.use("KHR_node_visibility")
        if len(keys) > 1:
            values = np.array([shows[place] for place in keys], dtype=np.uint8)
            target = _pointer_target(f"/nodes/{node}/extensions/KHR_node_visibility/visible")
            self._add(values, target, times_s=self._times_s[keys], interpolation="STEP")
            self._glb.use("KHR_animation_pointer")

    def _add(self, values: np.ndarray, target: dict[str, Any], times_s: np.ndarray | None = None,
             interpolation: str = "LINEAR") -> None:
        times_s = self._times_s if times_s is None else times_s
        self._samplers.append({"input": self._glb.numbers(times_s.astype(np.float32), bounds=True),
                               "output": self._glb.numbers(values), "interpolation": interpolation})
        self._channels.append({"sampler": len(self._samplers) - 1, "target": target})

    def finish(self) -> None:
        """Writes the animation, where anything moves."""
        if self._channels:
            self._glb.add("animations", {"name": "Shot", "samplers": self._samplers, "channels": self._channels})


def changes(values: np.ndarray) -> bool:
    """Whether rows differ."""
    values = np.asarray(values, dtype=np.float64)
    return bool(np.abs(values - values[0]).max() > TOLERANCE * max(float(np.abs(values[0]).max()), 1.0))


def _pointer_target(pointer: str) -> dict[str, Any]:
    return {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}
