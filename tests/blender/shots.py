# Makes shots in a real Blender, exports each as OUT/NAME.glb, and writes what Blender itself says of every frame as
# OUT/NAME.json: field of view, and where vertices are in the world and in a picture of 640 by 360 pixels.
# Run: python shots.py OUT (with bpy).
import bpy, json, math, os, sys
from bpy_extras.object_utils import world_to_camera_view

OUT, WIDTH, HEIGHT, LAST = sys.argv[1], 640, 360, 24


def fresh():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.render.fps = 0, LAST, 24
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, HEIGHT, 100
    return scene


def monkey(name, at=(0, 0, 0), parent=None):
    bpy.ops.mesh.primitive_monkey_add(location=at)
    made = bpy.context.object
    made.name = name
    if parent:
        made.parent = parent
    return made


def camera(scene, at=(7, -7, 4), toward=None, lens=35.0):
    data = bpy.data.cameras.new('Cam')
    made = bpy.data.objects.new('Cam', data)
    scene.collection.objects.link(made)
    made.location = at
    data.lens = lens
    if toward:
        follow = made.constraints.new('TRACK_TO')
        follow.target = toward
    scene.camera = made
    return made


def keyed(thing, path, values):
    for frame, value in values:
        setattr(thing, path, value)
        thing.keyframe_insert(path, frame=frame)


def nested():
    scene = fresh()
    base = monkey('base')
    keyed(base, 'rotation_euler', [(0, (0, 0, 0)), (24, (0.3, 0.9, 2.4))])
    base.scale = (1, 1, 1)
    child = monkey('child', (2.2, 0.3, 0.4), base)
    keyed(child, 'location', [(0, (2.2, 0.3, 0.4)), (24, (1.8, -1.0, 1.2))])
    child.scale = (0.5, 0.8, 0.6)
    grandchild = monkey('grandchild', (0, 2.0, 0), child)
    keyed(grandchild, 'rotation_euler', [(0, (0, 0, 0)), (24, (0, 7 * math.pi / 180, 137 * math.pi / 180))])
    keyed(base, 'scale', [(0, (1, 1, 1)), (24, (1.3, 1.3, 1.3))])
    seen = camera(scene, toward=base)
    keyed(seen, 'location', [(0, (7, -7, 4)), (24, (3, -9, 1))])
    keyed(seen.data, 'lens', [(0, 28.0), (24, 60.0)])


def constrained():
    scene = fresh()
    bpy.ops.curve.primitive_bezier_circle_add(radius=2.5)
    path = bpy.context.object
    path.data.use_path = True
    runner = monkey('runner')
    follow = runner.constraints.new('FOLLOW_PATH')
    follow.target, follow.use_curve_follow = path, True
    path.data.path_duration = 48
    path.data.eval_time = 0
    path.data.keyframe_insert('eval_time', frame=0)
    path.data.eval_time = 30
    path.data.keyframe_insert('eval_time', frame=24)
    copier = monkey('copier', (0, 0, 2))
    copy = copier.constraints.new('COPY_ROTATION')
    copy.target = runner
    camera(scene, (6, -8, 5), toward=copier)


def layered():
    scene = fresh()
    thing = monkey('thing')
    keyed(thing, 'location', [(0, (0, 0, 0)), (12, (1, 0, 0))])
    first = thing.animation_data.action
    track = thing.animation_data.nla_tracks.new()
    strip = track.strips.new('move', 0, first)
    strip.repeat, strip.blend_type = 2.0, 'REPLACE'
    thing.animation_data.action = None
    keyed(thing, 'rotation_euler', [(0, (0, 0, 0)), (24, (0, 0, 3.0))])
    data = camera(scene, (0, -9, 2.5)).data
    scene.camera.rotation_euler = (math.radians(75), math.radians(30), 0)
    data.type, data.ortho_scale = 'ORTHO', 7.0


def mirrored():
    scene = fresh()
    left = monkey('left', (1.6, 0, 0))
    left.scale = (-1, 1, 1)
    keyed(left, 'rotation_euler', [(0, (0, 0, 0)), (24, (0.2, 0.1, -2.0))])
    flat = monkey('flat', (-1.8, 0, 0))
    flat.scale = (1.0, 0.2, -1.5)
    keyed(flat, 'location', [(0, (-1.8, 0, 0)), (24, (-1.2, 1, 0.5))])
    keyed(flat, 'rotation_euler', [(0, (0, 0, 0)), (24, (0, 1.0, 0))])
    camera(scene, (2, -9, 3), toward=left)


def bending():
    scene = fresh()
    # Shape keys, two at once, under an uneven scale that changes.
    ball = monkey('ball', (-2.5, 0, 0))
    for key, stretch in (('Basis', (1, 1, 1)), ('Tall', (1, 1, 1.7)), ('Wide', (1.5, 0.8, 1))):
        block = ball.shape_key_add(name=key)
        for point in block.data:
            point.co = [at * by for at, by in zip(point.co, stretch)]
    for key, values in (('Tall', [(0, 0.0), (24, 1.0)]), ('Wide', [(0, 0.3), (12, 0.9), (24, 0.1)])):
        keyed(ball.data.shape_keys.key_blocks[key], 'value', values)
    keyed(ball, 'scale', [(0, (1, 1, 1)), (24, (1.6, 0.7, 1.1))])
    # A figure of 10,000 vertices, which 40 bones in a chain roll up.
    bones, rings, around, length = 40, 200, 50, 4.0
    points = [(length * ring / (rings - 1), 0.4 * math.cos(2 * math.pi * side / around),
               0.4 * math.sin(2 * math.pi * side / around)) for ring in range(rings) for side in range(around)]
    faces = [(ring * around + side, ring * around + (side + 1) % around,
              (ring + 1) * around + (side + 1) % around, (ring + 1) * around + side)
             for ring in range(rings - 1) for side in range(around)]
    data = bpy.data.meshes.new('worm')
    data.from_pydata(points, [], faces)
    worm = bpy.data.objects.new('worm', data)
    scene.collection.objects.link(worm)
    rig = bpy.data.objects.new('rig', bpy.data.armatures.new('rig'))
    scene.collection.objects.link(rig)
    rig.location, rig.rotation_euler = (0.5, 0.3, -0.2), (0, 0, 0.4)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode='EDIT')
    before = None
    for number in range(bones):
        bone = rig.data.edit_bones.new('bone%d' % number)
        bone.head, bone.tail = (length * number / bones, 0, 0), (length * (number + 1) / bones, 0, 0)
        bone.parent, bone.use_connect = before, before is not None
        before = bone
    bpy.ops.object.mode_set(mode='OBJECT')
    worm.parent = rig
    worm.modifiers.new('rig', 'ARMATURE').object = rig
    groups = [worm.vertex_groups.new(name='bone%d' % number) for number in range(bones)]
    for index, (x, _, _) in enumerate(points):
        weights = [math.exp(-((x * bones / length - number - 0.5) / 0.8) ** 2) for number in range(bones)]
        largest = sorted(range(bones), key=lambda number: -weights[number])[:4]
        total = sum(weights[number] for number in largest)
        for number in largest:
            groups[number].add([index], weights[number] / total, 'REPLACE')
    for number in range(bones):
        pose = rig.pose.bones['bone%d' % number]
        pose.rotation_mode = 'XYZ'
        keyed(pose, 'rotation_euler', [(0, (0, 0, 0)), (24, (0.02 * (number % 3), 0, 0.11))])
    keyed(rig, 'location', [(0, (0.5, 0.3, -0.2)), (24, (0, 1.0, 0.4))])
    camera(scene, (1, -11, 3), toward=ball)


def say(name):
    scene = bpy.context.scene
    frames = []
    for number in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(number)
        graph = bpy.context.evaluated_depsgraph_get()
        seen = scene.camera.evaluated_get(graph)
        # The angle is that of the picture's longer side.
        fov_y = 2 * math.atan(math.tan(seen.data.angle / 2) * HEIGHT / WIDTH)
        row = {'frame': number, 'fov_y_rad': fov_y if seen.data.type == 'PERSP' else None, 'objects': {}}
        for instance in graph.object_instances:
            thing = instance.object
            if thing.type != 'MESH' or instance.is_instance:
                continue
            mesh = thing.to_mesh()
            places = []
            for vertex in mesh.vertices:
                world = instance.matrix_world @ vertex.co
                at = world_to_camera_view(scene, seen, world)
                places.append([*world, at.x * WIDTH, at.y * HEIGHT])
            row['objects'][thing.name] = places
            thing.to_mesh_clear()
        frames.append(row)
    with open(os.path.join(OUT, name + '.json'), 'w') as file:
        json.dump(frames, file)


os.makedirs(OUT, exist_ok=True)
for make in (nested, constrained, layered, mirrored, bending):
    make()
    say(make.__name__)
    bpy.context.scene.frame_set(0)
    bpy.ops.export_scene.gltf(
        filepath=os.path.join(OUT, make.__name__ + '.glb'), export_cameras=True, export_lights=True,
        export_animation_mode='SCENE', export_pointer_animation=True, export_anim_scene_split_object=False,
        export_force_sampling=True)
# Blender 4.2 as a module crashes when it exits after an export.
sys.stdout.flush()
os._exit(0)
