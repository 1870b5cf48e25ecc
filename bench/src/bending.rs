//! Measures what a body that bends costs in a frame: its vertices moved by joints, its deformation gradients F, its
//! particles carried and solved, and a point cache. Each is timed beside its floor, the least time that memory allows
//! (see `floor.rs`). "In" and "Out" below count the numbers per vertex or particle that are read and written.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use anyhow::{anyhow, ensure};
use glam::{DAffine3, DVec3, Vec3};
use impasto_core::TriangleMesh;
use impasto_core::bending::{
    Bend, BendPose, Bonds, Carrier, Gradients, SkinWeights, SortedParticles, Vertices,
};
use impasto_core::lift::Lift;
use impasto_core::sampling::{PackedParticle, Particle};
use impasto_core::solve::{BakedParticles, Bounds, ParticleView, SolvedParticles, solve};
use impasto_core::{ScreenMap, screen_map::PixelLens};
use impasto_painting::{Painting, Preparer};
use impasto_scene::load::{LoadOptions, load};

use crate::bench::Bench;
use crate::floor::Streams;
use crate::race::{Contender, race};
use crate::table::Row;

/// Rings of a bar, and vertices round each: 100,000 vertices.
const RINGS: u32 = 400;
const AROUND: u32 = 250;

const JOINTS: usize = 24;
const PARTICLES: u32 = 355_000;

/// Measures a bar that joints roll up.
pub fn run(bench: &mut Bench) -> anyhow::Result<()> {
    let (mesh, bend) = bar();
    let name = format!("{} vertices, 4 joints each", mesh.positions.len());
    let pose = rolled_up();
    let bent = bend.at(&pose);
    ensure!(bent.positions.iter().all(|at| at.is_finite()), "a vertex is nowhere");
    let contenders = vec![
        Contender::here("Impasto", "", || bend.at(&pose)),
        // In: position, normal, four weights and four joints of two bytes. Out: position and normal.
        Streams::new(mesh.positions.len(), 12, 6).contender(),
    ];
    let figures = race(&bench.pace(false), contenders)?;
    bench.push(Row::of_race("vertices and normals of a frame", &name, figures, true));

    let gradients = Gradients::new(&mesh, Bonds::Bend(&bend));
    let strain = || Carrier::new(&bent.positions, &gradients.at(&bent.positions));
    let contenders = vec![
        Contender::here("Impasto", "", strain),
        // In: six edges of three numbers, the matrix M⁻¹ that `Gradients` stores, and position. Out: position and F.
        Streams::new(mesh.positions.len(), 6 * 3 + 9 + 3, 12).contender(),
    ];
    let figures = race(&bench.pace(false), contenders)?;
    bench.push(Row::of_race("how the surface is strained", &name, figures, true));

    let carrier = strain();
    let (places, baked) = particles(&mesh);
    let map = ScreenMap::new(
        glam::DMat4::from_translation(DVec3::new(0.0, 0.0, -6.0)),
        DAffine3::IDENTITY,
        PixelLens::Perspective { focal_px: 1000.0 },
    );
    let input = format!("{PARTICLES} particles, {name}");
    let sorted = SortedParticles::new(&places, &baked.placed, &[], |_| 0.0);
    let view = ParticleView::new(&map);
    // Where a unit of surface covers 20,000 px², the first 10,000 particles are present: as many as in a picture that
    // is full of strokes.
    let bounds =
        Bounds { half_px: [640.0, 360.0], near_far: [0.1, 100.0], most_per_area: 10_000.0 / 20_000.0 };
    let mut showing = 0;
    let contenders = vec![
        Contender::here("Impasto", "those that show", || {
            let words = carrier.within(&mesh, &sorted, &view, &bounds);
            let mut sum = 0.0;
            showing = 0;
            for (word, bits) in words.iter().enumerate() {
                let mut bits = *bits;
                while bits != 0 {
                    let index = word * 64 + bits.trailing_zeros() as usize;
                    bits &= bits - 1;
                    let vectors = carrier.particle(&mesh, places[index], at_rest(&baked, index), 0.0);
                    sum += view.solved_at(vectors.map(|vector| vector.to_array()), None).angle_rad;
                    showing += 1;
                }
            }
            sum
        }),
        // In, for every particle: place, number, normal and height (8 numbers). Out: a bit, counted as a number.
        Streams::new(places.len(), 8, 1).contender(),
    ];
    let figures = race(&bench.pace(false), contenders)?;
    ensure!(showing > 1000, "{showing} show");
    let mut row = Row::of_race("carry and cull all, solve those that show", &input, figures, true);
    row.ours.note = format!("{showing} show");
    bench.push(row);

    let mut solved = SolvedParticles::default();
    let contenders = vec![
        Contender::here("Impasto", "", || {
            let carried = carrier.carry(&mesh, &places, &baked, |_| 0.0);
            solve(&carried, &map, &mut solved);
        }),
        // In: place (3), baked values (12), and the carried values (12) once they are written. Out: carried values
        // (12), solved values (5).
        Streams::new(places.len(), 3 + 12 + 12, 12 + 5).contender(),
    ];
    let figures = race(&bench.pace(false), contenders)?;
    bench.push(Row::of_race("carry, project and solve all", &input, figures, true));
    point_cache(bench)
}

/// Points along each side of a cloth, which has 160,801 points.
const SIDE: usize = 401;

const SAMPLES: usize = 32;

/// Measures a frame of a point cache: a sample is read, and vertices, normals and F are made from it.
fn point_cache(bench: &mut Bench) -> anyhow::Result<()> {
    let folder = std::env::temp_dir().join(format!("impasto-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let outcome = cloth_of(&folder).and_then(|painting| {
        let mut frame = 0.0;
        let contenders = vec![
            Contender::here("Impasto", "", || {
                frame = (frame + 7.0) % SAMPLES as f64;
                painting.bent_at(frame)
            }),
            // In: the sample as bytes and as points, and six edges of three numbers. Out: position and normal, then
            // position and F, padded to 16 numbers.
            Streams::new(SIDE * SIDE, 3 + 3 + 6 * 3, 6 + 16).contender(),
        ];
        race(&bench.pace(false), contenders)
    });
    std::fs::remove_dir_all(&folder)?;
    let input = format!("{} points, a sample of {} kB", SIDE * SIDE, SIDE * SIDE * 12 / 1000);
    bench.push(Row::of_race("a frame of a point cache", &input, outcome?, true));
    Ok(())
}

/// Writes the files of a cloth with a point cache, and prepares its scene without strokes.
fn cloth_of(folder: &Path) -> anyhow::Result<Painting> {
    let place =
        |index: usize| [index % SIDE, index / SIDE].map(|at| at as f32 * 4.0 / (SIDE - 1) as f32 - 2.0);
    let mut obj = String::new();
    for index in 0..SIDE * SIDE {
        let [x, y] = place(index);
        writeln!(obj, "v {x} {y} 0")?;
    }
    for corner in (0..SIDE * (SIDE - 1)).filter(|corner| corner % SIDE != SIDE - 1) {
        writeln!(obj, "f {} {} {} {}", corner + 1, corner + 2, corner + SIDE + 2, corner + SIDE + 1)?;
    }
    let mut cache = b"POINTCACHE2\0".to_vec();
    cache.extend(1i32.to_le_bytes().into_iter().chain(((SIDE * SIDE) as i32).to_le_bytes()));
    cache.extend(0f32.to_le_bytes().into_iter().chain(1f32.to_le_bytes()));
    cache.extend((SAMPLES as i32).to_le_bytes());
    for sample in 0..SAMPLES {
        for [x, y] in (0..SIDE * SIDE).map(place) {
            let z = 0.2 * (3.0 * x + sample as f32 * 0.1).sin() * (2.0 * y).cos();
            cache.extend([x, y, z].into_iter().flat_map(f32::to_le_bytes));
        }
    }
    std::fs::write(folder.join("cloth.obj"), obj)?;
    std::fs::write(folder.join("cloth.pc2"), cache)?;
    let scene = folder.join("cloth.ron");
    std::fs::write(
        &scene,
        "(version: 1, size: (640, 360), camera: (keys: [(frame: 0, eye: (0, 0, 8), target: (0, 0, 0))]), \
         objects: [(name: \"cloth\", mesh: \"cloth.obj\", cache: \"cloth.pc2\")])",
    )?;
    let loaded = load(&scene, &LoadOptions::default()).map_err(|report| anyhow!("{report}"))?;
    let painting = Preparer::default().prepare_plain(&Arc::new(loaded))?;
    // A first call, so that what is computed once per surface is not timed.
    painting.bent_at(1.0);
    Ok(painting)
}

fn bar() -> (TriangleMesh, Bend) {
    let (mut mesh, mut skin) =
        (TriangleMesh::default(), SkinWeights { per_vertex: 4, ..SkinWeights::default() });
    for ring in 0..RINGS {
        let along = ring as f32 / (RINGS - 1) as f32;
        for side in 0..AROUND {
            let (sin, cos) = (std::f32::consts::TAU * side as f32 / AROUND as f32).sin_cos();
            mesh.positions.push(Vec3::new(4.0 * along - 2.0, 0.3 * sin, 0.3 * cos));
            mesh.normals.push(Vec3::new(0.0, sin, cos));
            let first = (along * (JOINTS - 4) as f32) as u16;
            let part = (along * (JOINTS - 4) as f32).fract();
            skin.joints.extend([first, first + 1, first + 2, first + 3]);
            skin.weights.extend([0.4 * (1.0 - part), 0.4, 0.2, 0.4 * part]);
        }
    }
    for ring in 0..RINGS - 1 {
        for side in 0..AROUND {
            let at = |ring: u32, side: u32| ring * AROUND + side % AROUND;
            let [a, b, c, d] =
                [at(ring, side), at(ring + 1, side), at(ring + 1, side + 1), at(ring, side + 1)];
            mesh.triangles.extend([[a, c, b], [a, d, c]]);
        }
    }
    let bound = Vertices { positions: mesh.positions.clone(), normals: mesh.normals.clone() };
    (mesh, Bend { bound, skin: Some(skin), ..Bend::default() })
}

/// A pose in which each joint turns a little more than the one before.
fn rolled_up() -> BendPose {
    let mut world = DAffine3::IDENTITY;
    let joints = (0..JOINTS).map(|joint| {
        let x = 4.0 * joint as f64 / JOINTS as f64 - 2.0;
        let about = DAffine3::from_translation(DVec3::X * x);
        world = world * about * DAffine3::from_rotation_z(0.12) * about.inverse();
        world
    });
    BendPose { weights: Vec::new(), joints: joints.collect() }
}

/// A particle's normal and the columns of its lift, at rest.
fn at_rest(baked: &BakedParticles, index: usize) -> [Vec3; 3] {
    let Lift { along, across } = baked.lift_of(index);
    [baked.placed.normal_of(index), along, across].map(|vector| vector.as_vec3())
}

fn particles(mesh: &TriangleMesh) -> (Vec<PackedParticle>, BakedParticles) {
    let (mut places, mut baked) = (Vec::new(), BakedParticles::default());
    for index in 0..PARTICLES {
        // Consecutive particles lie far apart, as those of a painting do.
        let triangle = (u64::from(index) * 2_654_435_761 % mesh.triangles.len() as u64) as u32;
        let particle = Particle {
            triangle,
            barycentric: [0.2, 0.5],
            flipped: false,
            position: Vec3::ZERO,
            normal: Vec3::Y,
        };
        let place = PackedParticle::of(&particle);
        let on = place.on(mesh);
        let lift = Lift { along: DVec3::X * 0.01, across: on.normal.as_dvec3().cross(DVec3::X) * 0.01 };
        baked.push(on.position.as_dvec3(), on.normal.as_dvec3(), lift);
        places.push(place);
    }
    (places, baked)
}
