"""The passes: which of Impasto's AOVs fills which pass of Blender."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from .exr import Planes


@dataclass(frozen=True)
class RenderPass:
    """A pass of Blender, and the channels of our file that fill it."""

    name: str
    # One letter for each of its channels, as Blender has them.
    letters: str
    # VALUE, VECTOR or COLOR.
    kind: str
    # As `--aov` takes it; empty for the picture itself.
    aov: str
    channels: tuple[str, ...]
    # The property of the view layer (`name`), or of ours (`impasto.name`), that asks for it.
    asked_by: str
    # Whether it is a direction in the world, whose axes differ.
    is_direction: bool = False


def _crypto(kind: str, aov: str, asked_by: str) -> list[RenderPass]:
    return [
        RenderPass(f"{kind}{rank:02}", "RGBA", "COLOR", aov, tuple(f"{kind}{rank:02}.{c}" for c in "RGBA"), asked_by)
        for rank in range(3)
    ]


COMBINED = RenderPass("Combined", "RGBA", "COLOR", "", ("R", "G", "B", "A"), "")

PASSES: list[RenderPass] = [
    RenderPass("Depth", "Z", "VALUE", "depth", ("Z",), "use_pass_z"),
    RenderPass("Normal", "XYZ", "VECTOR", "normal", ("N.X", "N.Y", "N.Z"), "use_pass_normal", True),
    RenderPass(
        "Vector", "XYZW", "VECTOR", "motion", ("motion.X", "motion.Y", "motion.Z", "motion.W"), "use_pass_vector"
    ),
    *_crypto("CryptoObject", "crypto.object", "use_pass_cryptomatte_object"),
    *_crypto("CryptoMaterial", "crypto.material", "use_pass_cryptomatte_material"),
    *_crypto("CryptoStroke", "crypto.stroke", "impasto.crypto_strokes"),
    RenderPass("StrokeAngle", "X", "VALUE", "stroke.angle", ("stroke.angle.X",), "impasto.strokes"),
    RenderPass("StrokeId", "X", "VALUE", "stroke.id", ("stroke.id.X",), "impasto.strokes"),
    RenderPass("StrokeTrust", "X", "VALUE", "stroke.kappa", ("stroke.kappa.X",), "impasto.strokes"),
    RenderPass("StrokeLayer", "X", "VALUE", "stroke.layer", ("stroke.layer.X",), "impasto.strokes"),
    RenderPass(
        "PaintColor",
        "RGBA",
        "COLOR",
        "paint.color",
        tuple(f"paint.color.{c}" for c in "RGBA"),
        "impasto.paint",
    ),
    RenderPass(
        "PaintNormal",
        "XYZ",
        "VECTOR",
        "paint.normal",
        tuple(f"paint.normal.{c}" for c in "XYZ"),
        "impasto.paint",
    ),
    RenderPass("PaintHeight", "X", "VALUE", "paint.height", ("paint.height.X",), "impasto.paint"),
]


def asked(view_layer: bpy.types.ViewLayer) -> list[RenderPass]:
    """The passes that a view layer asks for, without Combined."""

    def is_asked(row: RenderPass) -> bool:
        own = row.asked_by.removeprefix("impasto.")
        return bool(getattr(view_layer.impasto if own != row.asked_by else view_layer, own, False))

    return [row for row in PASSES if is_asked(row)]


def pixels(row: RenderPass, planes: Planes) -> np.ndarray | None:
    """The pixels of a pass, rows from the bottom up: height, width, channels. None where the style has no such thing."""
    found = planes.flat(list(row.channels))
    if found is not None and row.is_direction:
        # Y up becomes Z up.
        x, y, z = found[..., 0], found[..., 1], found[..., 2]
        found = np.stack([x, -z, y], axis=-1)
    return found
