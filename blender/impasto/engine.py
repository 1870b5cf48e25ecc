"""Impasto as a render engine: final renders of frames and animations, in the window and with `blender -b`."""

from __future__ import annotations

import bpy

from . import cryptomatte, painting, passes, refusals
from .export.cameras import picture_size
from .export_request import export_request
from .exr import Planes, read
from .failure import Failure, Stopped
from .painter import painter_of


class ImpastoEngine(bpy.types.RenderEngine):
    """Paints the scene."""

    bl_idname = "IMPASTO"
    bl_label = "Impasto"
    bl_use_preview = False
    bl_use_eevee_viewport = True
    bl_use_postprocess = True
    bl_use_shading_nodes_custom = False
    # Nothing of a depsgraph is kept from frame to frame.
    bl_use_persistent_data = False

    def update_render_passes(self, scene: bpy.types.Scene, renderlayer: bpy.types.ViewLayer) -> None:
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for row in passes.asked(renderlayer):
            self.register_pass(scene, renderlayer, row.name, len(row.letters), row.letters, row.kind)

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        if self.is_preview:
            return
        # Nothing may leave this function: an exception between the begin and the end of a result ends Blender.
        try:
            self._paint(depsgraph)
        except Stopped:
            if export_request.is_on:
                export_request.failure = "Stopped: nothing was written"
        except Failure as failure:
            self._fail(str(failure))
        except Exception as error:  # noqa: BLE001
            self._fail(f"{type(error).__name__}: {error}")

    def _is_stopped(self) -> bool:
        """Whether Esc was pressed. Tests put something else in its place, which Blender's own functions do not allow."""
        return self.test_break()

    def _fail(self, words: str) -> None:
        if export_request.is_on:
            export_request.failure = words
            return
        # `report` makes the render operator raise an error, `error_set` shows the words in the render's window.
        self.report({"ERROR"}, words)
        self.error_set(words)

    def _paint(self, depsgraph: bpy.types.Depsgraph) -> None:
        # What a depsgraph names in a render is its own copy.
        scene = depsgraph.scene.original
        view_layer = scene.view_layers[depsgraph.view_layer.name]
        refusals.check(scene, view_layer)
        frame = depsgraph.scene_eval.frame_current
        place = painting.of_scene(scene)
        # In an animation the shot is exported with its first frame: nothing can change before the last.
        if not (self.is_animation and frame != scene.frame_start and place.shot.is_file()):
            self._export(place, depsgraph, view_layer)
        if export_request.is_on:
            return
        self.update_stats("", f"Impasto: painting frame {frame}")
        self.update_progress(0.5)
        rows = passes.asked(view_layer)
        how = {
            "size": self._whole_size_px(scene),
            "aovs": sorted({row.aov for row in rows}) or ["none"],
            "alpha": scene.render.film_transparent,
        }
        further: list[int] = []
        if self.is_animation:
            further = list(range(frame + scene.frame_step, scene.frame_end + 1, scene.frame_step))
        painter = painter_of(place.scene_file)
        path = painter.frame(frame, further, how, self._is_stopped)
        for words in painter.take_warnings():
            self.report({"WARNING"}, words)
        planes = read(path)
        path.unlink(missing_ok=True)
        self._hand_over(planes, [passes.COMBINED, *rows], depsgraph)
        self.update_progress(1.0)

    def _whole_size_px(self, scene: bpy.types.Scene) -> list[int]:
        return list(picture_size(scene))

    def _export(
        self, place: painting.Painting, depsgraph: bpy.types.Depsgraph, view_layer: bpy.types.ViewLayer
    ) -> None:
        """Exports the shot, where anything has changed."""
        frame = depsgraph.scene_eval.frame_current

        def walk(number: int) -> bpy.types.Depsgraph:
            self.frame_set(number, 0.0)
            return depsgraph

        def report(share: float) -> None:
            self.update_stats("", "Impasto: exporting the shot")
            self.update_progress(0.5 * share)

        warnings = painting.export(
            place,
            view_layer.id_data,
            walk,
            view_layer=view_layer,
            report=report,
            stop=self._is_stopped,
            anew=export_request.is_on and export_request.anew,
        )
        self.frame_set(frame, 0.0)
        export_request.warnings = warnings
        # An operator that asked for the export reports its warnings itself.
        for words in [] if export_request.is_on else warnings:
            self.report({"WARNING"}, words)

    def _hand_over(
        self, planes: Planes, rows: list[passes.RenderPass], depsgraph: bpy.types.Depsgraph
    ) -> None:
        """Copies the pixels of all passes, and the metadata of mattes, into Blender's result."""
        left, bottom, width, height = refusals.part_px(depsgraph.scene.render, planes.size_px)
        found = [(row, passes.pixels(row, planes)) for row in rows]
        result = self.begin_result(0, 0, width, height, layer=depsgraph.view_layer.name)
        try:
            of_layer = result.layers[0].passes
            for row, pixels in found:
                target = of_layer.get(row.name)
                if target is not None and pixels is not None:
                    part = pixels[bottom : bottom + height, left : left + width]
                    target.rect.foreach_set(part.ravel())
        finally:
            self.end_result(result)
        # `end_result` merges only pixels into the whole result; its metadata has to be set there directly.
        cryptomatte.stamp(self.get_result(), depsgraph.view_layer.name, planes.notes)


def register() -> None:
    bpy.utils.register_class(ImpastoEngine)


def unregister() -> None:
    bpy.utils.unregister_class(ImpastoEngine)
