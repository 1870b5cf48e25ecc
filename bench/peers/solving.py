"""The turn of each particle from its neighbours, in numpy or numba.

Arguments: WAY POSITIONS REFERENCE LISTS ROWS ANGLES.
"""

import math
import sys

import numpy

from rounds import serve

K = 48
way, angles_file = sys.argv[1], sys.argv[6]
positions = numpy.fromfile(sys.argv[2], "<f4").reshape(-1, 3)
reference = numpy.fromfile(sys.argv[3], "<f4").reshape(-1, 2)
lists = numpy.fromfile(sys.argv[4], "<u4").reshape(-1, K)
rows = numpy.fromfile(sys.argv[5], "<f4").reshape(3, 4)

if way == "numpy":

    def task():
        x, y, w = rows[:, :3] @ positions.T + rows[:, 3:]
        now = numpy.stack([x / w, y / w], axis=1)
        angles = numpy.empty(len(positions), "f4")
        # Blocks that stay in the cache: faster than all at once.
        for start in range(0, len(positions), 8192):
            block = slice(start, start + 8192)
            p = reference[lists[block]] - reference[block, None]
            c = now[lists[block]] - now[block, None]
            dot = (p * c).sum(axis=(1, 2))
            cross = (p[..., 0] * c[..., 1] - p[..., 1] * c[..., 0]).sum(axis=1)
            angles[block] = numpy.arctan2(cross, dot)
        return angles

else:
    import numba

    @numba.njit(parallel=True, fastmath=True, cache=True)
    def solve(positions, reference, lists, rows, now, angles):
        for i in numba.prange(len(positions)):
            x, y, z = positions[i]
            w = rows[2, 0] * x + rows[2, 1] * y + rows[2, 2] * z + rows[2, 3]
            now[i, 0] = (rows[0, 0] * x + rows[0, 1] * y + rows[0, 2] * z + rows[0, 3]) / w
            now[i, 1] = (rows[1, 0] * x + rows[1, 1] * y + rows[1, 2] * z + rows[1, 3]) / w
        for i in numba.prange(len(positions)):
            dot, cross = numpy.float32(0), numpy.float32(0)
            for k in range(lists.shape[1]):
                other = lists[i, k]
                px, py = reference[other, 0] - reference[i, 0], reference[other, 1] - reference[i, 1]
                cx, cy = now[other, 0] - now[i, 0], now[other, 1] - now[i, 1]
                dot += px * cx + py * cy
                cross += px * cy - py * cx
            angles[i] = math.atan2(cross, dot)

    now = numpy.empty((len(positions), 2), "f4")
    angles = numpy.empty(len(positions), "f4")

    def task():
        solve(positions, reference, lists, rows, now, angles)
        return angles


task().tofile(angles_file)
serve(task)
