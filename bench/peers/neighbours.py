"""scipy's tree: the nearest MOST within the radius. Arguments: WAY POINTS RADIUS MOST FOUND."""

import sys

import numpy
from scipy.spatial import cKDTree

from rounds import THREADS, serve

points = numpy.fromfile(sys.argv[2], "<f4").reshape(-1, 3)
radius, most = float(sys.argv[3]), int(sys.argv[4])


def task():
    tree = cKDTree(points)
    # One more: the particle itself is its own nearest. The bound is exclusive, so it lies just above the radius.
    return tree.query(points, k=most + 1, distance_upper_bound=radius * (1 + 1e-7), workers=THREADS)


_, found = task()
count = len(points)
others = found < count
others &= found != numpy.arange(count)[:, None]
answer = numpy.zeros(2 * count, "<u4")
answer[:count] = others.sum(axis=1)
answer[count:] = numpy.where(others, found, 0).sum(axis=1).astype("<u8") & 0xFFFFFFFF
answer.tofile(sys.argv[5])
del found, others
serve(task)
