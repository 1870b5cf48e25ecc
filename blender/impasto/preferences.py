"""The preferences of the add-on: where the program is."""

from __future__ import annotations

import bpy


class ImpastoPreferences(bpy.types.AddonPreferences):
    """Preferences > Add-ons > Impasto."""

    bl_idname = __package__

    program: bpy.props.StringProperty(  # type: ignore[valid-type]
        name="Program",
        description="The impasto program; left empty, the one beside this add-on, or else the one on the PATH",
        subtype="FILE_PATH",
    )

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.prop(self, "program")
        self.layout.operator("impasto.find_program")


class IMPASTO_OT_find_program(bpy.types.Operator):
    """Look for the program, and say which it is"""

    bl_idname = "impasto.find_program"
    bl_label = "Find the Program"

    def execute(self, _context: bpy.types.Context) -> set[str]:
        from . import binary
        from .failure import Failure

        try:
            self.report({"INFO"}, f"Impasto: {binary.find()}")
        except Failure as failure:
            self.report({"ERROR"}, str(failure))
            return {"CANCELLED"}
        return {"FINISHED"}


def program() -> str:
    """The path that the preferences name, absolute; empty for none."""
    addon = bpy.context.preferences.addons.get(__package__)
    if addon is None or not addon.preferences.program:
        return ""
    return bpy.path.abspath(addon.preferences.program)


def register() -> None:
    bpy.utils.register_class(ImpastoPreferences)
    bpy.utils.register_class(IMPASTO_OT_find_program)


def unregister() -> None:
    bpy.utils.unregister_class(IMPASTO_OT_find_program)
    bpy.utils.unregister_class(ImpastoPreferences)
