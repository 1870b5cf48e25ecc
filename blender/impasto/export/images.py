"""Pictures for glTF: PNG and JPEG files as they are, where they are unedited and sRGB; all else as a new PNG."""

from pathlib import Path

import bpy
import numpy as np

from .png import png_bytes

_LINEAR_SPACES = ("Non-Color", "Raw", "Linear")


def picture_bytes(image: bpy.types.Image) -> tuple[bytes, str] | None:
    """The file of a picture and its media type; `None` where the picture is missing."""
    is_as_stored = image.source == "FILE" and not image.is_dirty and not _is_linear(image)
    stored = _stored_bytes(image) if is_as_stored else None
    if stored is not None:
        kind = _media_type(stored)
        if kind is not None:
            return stored, kind
    pixels = _pixels(image)
    return None if pixels is None else (png_bytes(pixels), "image/png")


def _stored_bytes(image: bpy.types.Image) -> bytes | None:
    if image.packed_file is not None:
        return bytes(image.packed_file.data)
    path = Path(bpy.path.abspath(image.filepath_raw, library=image.library))
    try:
        return path.read_bytes()
    except OSError:
        return None


def _media_type(content: bytes) -> str | None:
    if content.startswith(b"\x89PNG\r\n\x1a\n"):
        return "image/png"
    return "image/jpeg" if content.startswith(b"\xff\xd8\xff") else None


def _is_linear(image: bpy.types.Image) -> bool:
    return image.colorspace_settings.name.startswith(_LINEAR_SPACES)


def _pixels(image: bpy.types.Image) -> np.ndarray | None:
    """Rows from the top, sRGB encoded bytes."""
    width, height = image.size
    channels = image.channels
    if width == 0 or height == 0 or len(image.pixels) != width * height * channels:
        return None
    flat = np.empty(width * height * channels, dtype=np.float32)
    image.pixels.foreach_get(flat)
    values = flat.reshape(height, width, channels)[::-1]
    if image.is_float or _is_linear(image):
        values = values.copy()
        values[:, :, :3] = srgb_from_linear(values[:, :, :3])
    if channels < 3:
        values = np.repeat(values[:, :, :1], 3, axis=2)
    return (np.clip(values, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def srgb_from_linear(values: np.ndarray) -> np.ndarray:
    """Encodes linear numbers."""
    values = np.clip(values, 0.0, 1.0)
    return np.where(values <= 0.0031308, values * 12.92, 1.055 * np.power(values, 1.0 / 2.4) - 0.055)
