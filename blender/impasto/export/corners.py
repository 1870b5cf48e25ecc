"""Joins the corners of a mesh that are alike into vertices."""

import numpy as np

_MIX = np.uint64(0x9E3779B97F4A7C15)
_SHIFT = np.uint64(29)


def joined(point: np.ndarray, columns: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """The corners that stand for a vertex each, in the order of their points, and the vertex of every corner.

    `point` is the point number of each corner, `columns` its other values, single precision or whole.
    """
    words = [_words(column) for column in columns]
    mixed = point.astype(np.uint64) * _MIX
    for word in words:
        mixed ^= mixed >> _SHIFT
        mixed += word
        mixed *= _MIX
    first, vertex = _order(mixed, point)
    # Two unlike corners may have the same mix, hardly ever.
    same = np.array_equal(point[first][vertex], point)
    if not same or not all(np.array_equal(word[first][vertex], word) for word in words):
        rows = np.stack([point.astype(np.uint64), *words], axis=1)
        _, exact = np.unique(rows, axis=0, return_inverse=True)
        first, vertex = _order(exact.ravel().astype(np.uint64), point)
    return first, vertex


def _order(keys: np.ndarray, point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    _, first, vertex = np.unique(keys, return_index=True, return_inverse=True)
    order = np.argsort(point[first], kind="stable")
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    return first[order], place[vertex.ravel()]


def _words(column: np.ndarray) -> np.ndarray:
    """Values as whole numbers; 0 and -0 are one."""
    if column.dtype.kind == "f":
        column = np.ascontiguousarray(column.astype(np.float32) + np.float32(0.0)).view(np.uint32)
    return column.astype(np.uint64)
