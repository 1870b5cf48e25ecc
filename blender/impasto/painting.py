"""The painting's folder beside the .blend: the shot as exported, and the scene file that is the user's."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import bpy

from . import binary, scene_file
from .export import ExportError, export_shot
from .export import Stopped as ExportStopped
from .export.inputs_sum import sum_of_inputs
from .failure import Failure, Stopped

SHOT = "shot.glb"
SIDECAR = "shot.impasto.json"


@dataclass(frozen=True)
class Painting:
    """Where the files of a scene's painting are."""

    folder: Path
    scene_file: Path

    @property
    def shot(self) -> Path:
        return self.folder / SHOT

    @property
    def sidecar(self) -> Path:
        return self.folder / SIDECAR


def of_scene(scene: bpy.types.Scene) -> Painting:
    """The painting of a scene: `film_impasto/film.ron` beside `film.blend`, or the folder that the scene names.

    Raises Failure where the .blend was never saved."""
    if not bpy.data.filepath:
        raise Failure("Save the .blend first: the painting's files lie beside it.")
    blend = Path(bpy.data.filepath)
    # Further scenes of a file have folders of their own.
    is_first = scene.name == bpy.data.scenes[0].name
    name = blend.stem if is_first else f"{blend.stem}_{bpy.path.clean_name(scene.name)}"
    folder = scene.impasto.folder
    place = Path(bpy.path.abspath(folder)) if folder else blend.parent / f"{name}_impasto"
    return Painting(place, place / f"{name}.ron")


def frames_of(scene: bpy.types.Scene) -> tuple[int, int]:
    """The first and the last frame of the shot."""
    return scene.frame_start, scene.frame_end


def sum_of_export(painting: Painting) -> str:
    """The sum of the inputs that the export in the folder was made from; empty where there is none."""
    return str(scene_file.sidecar(painting.sidecar).get("sum", "")) if painting.shot.is_file() else ""


def export(
    painting: Painting,
    scene: bpy.types.Scene,
    walk: Callable[[int], bpy.types.Depsgraph],
    *,
    view_layer: bpy.types.ViewLayer,
    report: Callable[[float], None],
    stop: Callable[[], bool],
    anew: bool = False,
) -> list[str]:
    """Exports the shot into the painting's folder, unless nothing has changed, and makes the scene file where there is none.

    Returns what could not be carried, in words. Raises Failure and Stopped."""
    frames = frames_of(scene)
    painting.folder.mkdir(parents=True, exist_ok=True)
    warnings: list[str] = scene_file.sidecar(painting.sidecar).get("warnings", [])
    if anew or sum_of_inputs(scene, view_layer, frames) != sum_of_export(painting):
        try:
            done = export_shot(
                walk, scene, painting.folder, frames=frames, report=report, stop=stop
            )
        except ExportStopped:
            raise Stopped from None
        except ExportError as error:
            raise Failure(str(error)) from error
        except OSError as error:
            raise Failure(f"The shot cannot be written: {error}.") from error
        warnings = done.warnings
    if not painting.scene_file.exists():
        binary.run(["new", str(painting.shot), "-o", str(painting.scene_file)])
    return warnings
