//! Times the sampling of the mesh of the paper's largest scene, by chance and as blue noise, and measures the spacing
//! that each blue-noise method reaches.

use std::hint::black_box;
use std::time::Instant;

use anyhow::{Context as _, ensure};
use glam::Vec3;
use impasto_core::TriangleMesh;
use impasto_core::neighbours::Neighbours;
use impasto_core::sampling::{Particle, Surface, hexagonal_spacing, progressive, scattered};

use crate::bench::Bench;
use crate::floor::Streams;
use crate::inputs::LARGEST;
use crate::peers::{Peer, files};
use crate::race::{Contender, race};
use crate::table::{Figure, Goal, Row, Spread, Unit, shown_count};

/// Spacings that differ by less than this share count as equal: two seeds of one method differ by as much.
const EQUAL_SPACING: f64 = 0.02;

/// Particles placed by chance, uniformly over the area.
pub fn by_chance(surface: &Surface<'_>, count: usize, seed: u32) -> Vec<Particle> {
    scattered(surface, count, seed)
}

/// Measures both kinds of sampling, each at several counts of particles.
pub fn run(bench: &mut Bench) -> anyhow::Result<()> {
    let mesh = bench.inputs.mesh()?;
    let counts: &[usize] = if bench.quick() { &[100_000] } else { &[LARGEST, 1_000_000] };
    for &count in counts {
        plain(bench, &mesh, count)?;
    }
    let counts: &[usize] = if bench.quick() { &[100_000] } else { &[100_000, LARGEST] };
    for &count in counts {
        blue(bench, &mesh, count)?;
    }
    Ok(())
}

/// Points with the normals of their triangles.
struct Sample {
    points: Vec<Vec3>,
    normals: Vec<Vec3>,
}

/// A Python peer that samples, with the answer of its first run.
struct Sampler {
    peer: Peer,
    sample: Sample,
}

fn sampler(bench: &mut Bench, way: &str, mesh: &TriangleMesh, count: usize) -> anyhow::Result<Sampler> {
    let folder = bench.peers.folder()?;
    let [vertices, triangles, found] =
        ["sampling.vertices", "sampling.triangles", "sampling.found"].map(|name| folder.join(name));
    files::write_floats(&vertices, mesh.positions.iter().flat_map(|point| point.to_array()))?;
    files::write_words(&triangles, mesh.triangles.iter().flatten().copied())?;
    let mut arguments: Vec<String> =
        [&vertices, &triangles, &found].map(|file| file.to_string_lossy().into_owned()).to_vec();
    arguments.push(count.to_string());
    let peer = bench.peers.python("sampling", way, &arguments)?;
    // Points and normals alternate.
    let found = files::read_points(&found)?;
    let of_each = |first: usize| found.iter().skip(first).step_by(2).copied().collect();
    Ok(Sampler { peer, sample: Sample { points: of_each(0), normals: of_each(1) } })
}

/// Checks the number of points, and that they fill the box of the mesh.
fn check(who: &str, mesh: &TriangleMesh, points: &[Vec3], least: usize, most: usize) -> anyhow::Result<()> {
    ensure!(
        (least..=most).contains(&points.len()),
        "{who} gave {} points where {most} were asked for",
        points.len()
    );
    let (low, high) = mesh.bounds().context("the mesh has triangles")?;
    let (least, greatest) =
        points.iter().fold((points[0], points[0]), |(low, high), &point| (low.min(point), high.max(point)));
    let slack = 0.02 * (high - low).max_element();
    let covered = (least - low).abs().max((greatest - high).abs());
    ensure!(
        covered.max_element() < slack,
        "{who} gave points that do not fill the box of the mesh, or leave it"
    );
    Ok(())
}

fn sample(mesh: &TriangleMesh, particles: &[Particle]) -> Sample {
    let normal = |particle: &Particle| {
        let [a, b, c] = mesh.corners(particle.triangle as usize);
        let across = (b - a).cross(c - a).normalize_or_zero();
        if particle.flipped { -across } else { across }
    };
    Sample {
        points: particles.iter().map(|particle| particle.position).collect(),
        normals: particles.iter().map(normal).collect(),
    }
}

fn plain(bench: &mut Bench, mesh: &TriangleMesh, count: usize) -> anyhow::Result<()> {
    let surface = Surface::new(mesh, |_| true);
    check("Impasto", mesh, &sample(mesh, &by_chance(&surface, count, 7)).points, count, count)?;
    let mut contenders = vec![Contender::here("Impasto", "", || by_chance(&surface, count, 7))];
    for (who, way) in [("Open3D", "open3d"), ("trimesh", "trimesh")] {
        let sampler = sampler(bench, way, mesh, count);
        if let Ok(sampler) = &sampler {
            check(who, mesh, &sampler.sample.points, count, count)?;
        }
        contenders.push(Contender::started(who, "1 thread", sampler.map(|sampler| sampler.peer.rounds())));
    }
    contenders.push(Streams::of_bytes(0, size_of::<Particle>() * count).contender());
    let figures = race(&bench.pace(false), contenders)?;
    let row = Row::of_race("sampling, by chance", &shown_count(count), figures, true);
    bench.push(row.meant(Goal::Faster { than: "Open3D", times: 5.0 }));
    Ok(())
}

fn blue(bench: &mut Bench, mesh: &TriangleMesh, count: usize) -> anyhow::Result<()> {
    let surface = Surface::new(mesh, |_| true);
    let input = shown_count(count);
    let ours = sample(mesh, &progressive(&surface, count, 7));
    check("Impasto", mesh, &ours.points, count, count)?;
    let mut spacings = vec![("Impasto", Ok::<_, String>(spacing(&ours, surface.area())))];
    drop(ours);
    let mut contenders =
        vec![Contender::here("Impasto", "progressive order", || progressive(&surface, count, 7))];
    let even = sampler(bench, "trimesh_even", mesh, count);
    if let Ok(even) = &even {
        check("trimesh", mesh, &even.sample.points, count / 2, count)?;
    }
    spacings.push((
        "trimesh even",
        even.as_ref().map(|even| spacing(&even.sample, surface.area())).map_err(|why| why.to_string()),
    ));
    contenders.push(Contender::started("trimesh even", "1 thread", even.map(|even| even.peer.rounds())));
    let figures = race(&bench.pace(false), contenders)?;
    let mut row = Row::of_race("sampling, blue noise", &input, figures, false);
    // Open3D's Poisson sampling is so slow that it runs only once.
    let poisson = sampler(bench, "open3d_poisson", mesh, count);
    let (mut figure, reached) = match poisson {
        Ok(poisson) => {
            check("Open3D Poisson", mesh, &poisson.sample.points, count, count)?;
            let secs = Spread::exact(poisson.peer.first_secs());
            (Figure::new("Open3D Poisson", Unit::Seconds, secs), Ok(spacing(&poisson.sample, surface.area())))
        }
        Err(why) => {
            let why = format!("{why:#}");
            (Figure::missing("Open3D Poisson", Unit::Seconds, &why), Err(why))
        }
    };
    figure.note = "disks, init_factor 5; 1 thread".to_owned();
    row.peers.push(figure);
    spacings.push(("Open3D Poisson", reached));
    row = row.meant(Goal::Faster { than: "Open3D Poisson", times: 50.0 });
    if count == LARGEST {
        row = row.meant(Goal::AtMost(0.4));
    }
    bench.push(row);
    for (index, what) in ["spacing, mean", "spacing, closest 0.1 %"].into_iter().enumerate() {
        let mut figures: Vec<Figure> = spacings
            .iter()
            .map(|(who, reached)| {
                let figure = match reached {
                    Ok(reached) => Figure::new(who, Unit::Ratio, Spread::exact(reached[index])),
                    Err(why) => Figure::missing(who, Unit::Ratio, why),
                };
                let across = reached.as_ref().map_or(0.0, |reached| reached[index + 2]);
                figure.noted(format!("of the hexagonal spacing; {across:.3} across edges too"))
            })
            .collect();
        let (least, theirs) = (figures[0].median(), figures.last().and_then(Figure::median));
        if let Some((ours, theirs)) = least.zip(theirs) {
            let verdict = if ours >= theirs * (1.0 - EQUAL_SPACING) { "held" } else { "MISSED" };
            figures[0].note += &format!("; goal equal to or better than Open3D Poisson: {verdict}");
        }
        bench.push(Row::of_race(what, &input, figures, false));
    }
    Ok(())
}

/// How well the points keep apart. The distance of each point to its nearest neighbour is divided by
/// [`hexagonal_spacing`], the greatest spacing that so many points can have, and capped at 1.5. Returns the mean of
/// these numbers, and the number that only one point in a thousand is below; then the same two again. The first two
/// look only at neighbours on the same side of the surface (n·n' > 0), since only their strokes crowd each other. The
/// last two look at all neighbours.
fn spacing(sample: &Sample, area: f64) -> [f64; 4] {
    let points = &sample.points;
    let hexagonal = hexagonal_spacing(area, points.len());
    let reached = |normals: &[Vec3]| {
        let found = Neighbours::find(points, normals, (1.5 * hexagonal) as f32);
        let nearest = |point: usize| {
            let near = found.of(point).iter().map(|&other| points[point].distance(points[other as usize]));
            f64::from(near.fold(1.5 * hexagonal as f32, f32::min)) / hexagonal
        };
        let mut nearest: Vec<f64> = (0..points.len()).map(nearest).collect();
        nearest.sort_by(f64::total_cmp);
        [nearest.iter().sum::<f64>() / points.len() as f64, nearest[points.len() / 1000]]
    };
    let [mean, closest] = reached(&sample.normals);
    let [mean_of_all, closest_of_all] = reached(&vec![Vec3::Y; points.len()]);
    [mean, closest, mean_of_all, closest_of_all]
}

/// The seconds that sampling by chance and as blue noise take at a count, for the plots.
pub fn secs(mesh: &TriangleMesh, count: usize) -> [f64; 2] {
    let surface = Surface::new(mesh, |_| true);
    let timed = |work: &dyn Fn() -> usize| {
        let start = Instant::now();
        black_box(work());
        start.elapsed().as_secs_f64()
    };
    [timed(&|| by_chance(&surface, count, 7).len()), timed(&|| progressive(&surface, count, 7).len())]
}
