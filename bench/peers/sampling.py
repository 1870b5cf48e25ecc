"""Points on a mesh. Arguments: WAY VERTICES TRIANGLES FOUND COUNT."""

import sys
import time

import numpy

from rounds import serve

way, found, count = sys.argv[1], sys.argv[4], int(sys.argv[5])
vertices = numpy.fromfile(sys.argv[2], "<f4").reshape(-1, 3).astype(float)
triangles = numpy.fromfile(sys.argv[3], "<u4").reshape(-1, 3).astype("i4")

if way.startswith("open3d"):
    import open3d

    mesh = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(vertices), open3d.utility.Vector3iVector(triangles)
    )

    def task():
        if way == "open3d":
            return mesh.sample_points_uniformly(count)
        return mesh.sample_points_poisson_disk(count, init_factor=5)

    def answer_of(cloud):
        # The nearest triangle is the point's own.
        scene = open3d.t.geometry.RaycastingScene()
        scene.add_triangles(open3d.t.geometry.TriangleMesh.from_legacy(mesh))
        points = numpy.asarray(cloud.points)
        nearest = scene.compute_closest_points(points.astype("f4"))["primitive_ids"].numpy()
        return points, nearest

else:
    import trimesh

    mesh = trimesh.Trimesh(vertices, triangles, process=False)

    def task():
        # Areas are kept by the mesh from one call to the next.
        if way == "trimesh":
            return trimesh.sample.sample_surface(mesh, count)
        return trimesh.sample.sample_surface_even(mesh, count)

    def answer_of(cloud):
        return cloud


start = time.perf_counter()
answer = task()
secs = time.perf_counter() - start
points, of_triangle = answer_of(answer)
a, b, c = (vertices[triangles[of_triangle, corner]] for corner in range(3))
normals = numpy.cross(b - a, c - a)
normals /= numpy.maximum(numpy.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
# Point and normal alternate.
numpy.stack([points, normals], axis=1).astype("<f4").tofile(found)
del answer, points
serve(task, secs)
