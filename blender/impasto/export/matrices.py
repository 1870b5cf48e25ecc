"""World matrices as glTF has them: Y up, and parted into translation, rotation and scale."""

from dataclasses import dataclass

import numpy as np

# Blender's (x, y, z) is glTF's (x, z, -y).
Y_UP_FROM_Z_UP = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=np.float64)

# How far a matrix may be from translation, rotation and scale before it counts as sheared. Blender's own are of single
# precision: a chain of parents is off by about 1e-6 without any shear.
SHEAR_TOLERANCE = 4e-6


@dataclass
class Parted:
    """Matrices in parts, a row for each."""

    translation: np.ndarray
    rotation_xyzw: np.ndarray
    scale: np.ndarray
    is_sheared: bool


def of_mesh(world_from_object: np.ndarray) -> np.ndarray:
    """The matrices for geometry that is Y up itself."""
    return Y_UP_FROM_Z_UP @ world_from_object @ Y_UP_FROM_Z_UP.T


def of_looker(world_from_object: np.ndarray) -> np.ndarray:
    """The matrices for a camera or a light, which look along -Z in Blender and glTF alike; without scale."""
    matrices = Y_UP_FROM_Z_UP @ world_from_object
    lengths = np.linalg.norm(matrices[:, :3, :3], axis=1, keepdims=True)
    matrices[:, :3, :3] /= np.where(lengths > 0.0, lengths, 1.0)
    return matrices


def parted(matrices: np.ndarray) -> Parted:
    """Translation, rotation and scale of matrices, frame by frame; quaternions do not flip sign between frames."""
    linear = matrices[:, :3, :3]
    scale = np.linalg.norm(linear, axis=1)
    scale = np.where(np.linalg.det(linear)[:, None] < 0.0, -scale, scale)
    turned = linear / np.where(scale == 0.0, 1.0, scale)[:, None, :]
    for row in np.flatnonzero((scale == 0.0).any(axis=1)):
        turned[row] = _completed(turned[row], scale[row] == 0.0)
    products = np.swapaxes(turned, 1, 2) @ turned - np.eye(3)
    is_sheared = bool(np.abs(products).max() > SHEAR_TOLERANCE)
    return Parted(matrices[:, :3, 3].copy(), _quaternions(turned), scale, is_sheared)


def _completed(turned: np.ndarray, is_flat: np.ndarray) -> np.ndarray:
    """A rotation of which only some columns are known, because the others are scaled to nothing."""
    known = [turned[:, column] for column in range(3) if not is_flat[column]]
    result = turned.copy()
    if len(known) == 2:
        column = int(np.flatnonzero(is_flat)[0])
        result[:, column] = np.cross(turned[:, (column + 1) % 3], turned[:, (column + 2) % 3])
    elif len(known) == 1:
        column = int(np.flatnonzero(~is_flat)[0])
        aside = np.cross(known[0], np.eye(3)[int(np.argmin(np.abs(known[0])))])
        result[:, (column + 1) % 3] = aside / np.linalg.norm(aside)
        result[:, (column + 2) % 3] = np.cross(known[0], result[:, (column + 1) % 3])
    else:
        result = np.eye(3)
    return result


def _quaternions(turned: np.ndarray) -> np.ndarray:
    """Quaternions (x, y, z, w) of rotation matrices, without jumps of the sign."""
    m = turned
    xx, yy, zz = m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]
    # Row i of `ways` is 4 q[i] q, so each, normalized, is the quaternion q (or -q); the longest is the most exact.
    ways = np.empty((len(m), 4, 4))
    ways[:, 0] = np.stack([1 + xx - yy - zz, m[:, 0, 1] + m[:, 1, 0], m[:, 0, 2] + m[:, 2, 0], m[:, 2, 1] - m[:, 1, 2]], 1)
    ways[:, 1] = np.stack([ways[:, 0, 1], 1 - xx + yy - zz, m[:, 1, 2] + m[:, 2, 1], m[:, 0, 2] - m[:, 2, 0]], 1)
    ways[:, 2] = np.stack([ways[:, 0, 2], ways[:, 1, 2], 1 - xx - yy + zz, m[:, 1, 0] - m[:, 0, 1]], 1)
    ways[:, 3] = np.stack([ways[:, 0, 3], ways[:, 1, 3], ways[:, 2, 3], 1 + xx + yy + zz], 1)
    lengths = np.linalg.norm(ways, axis=2)
    best = np.argmax(lengths, axis=1)
    rows = np.arange(len(m))
    quaternions = ways[rows, best] / lengths[rows, best, None]
    if quaternions[0, 3] < 0.0:
        quaternions[0] *= -1.0
    signs = np.where((quaternions[1:] * quaternions[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)
    quaternions[1:] *= np.cumprod(signs)[:, None]
    return quaternions
