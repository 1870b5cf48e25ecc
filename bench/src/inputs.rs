//! The inputs of the benchmarks: the source paper's three scenes, and any number of particles on the mesh of the
//! largest one.

use std::borrow::Borrow;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use anyhow::Context as _;
use glam::Vec3;
use impasto_core::TriangleMesh;
use impasto_core::sampling::{Particle, Surface, progressive};
use impasto_painting::Painting;
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::loaded::LoadedScene;

use crate::table::shown_count;

/// A scene of the source paper, with its figures from table 2 there.
#[derive(Clone, Copy, Debug)]
pub struct PaperScene {
    /// Name of the scene file.
    pub file: &'static str,
    /// Index of the model among the objects.
    pub object: usize,
    /// Particles; our scene has as many.
    pub particles: usize,
    /// Visible strokes.
    pub visible: usize,
    /// Seconds of preparing.
    pub prepare_secs: f64,
    /// Seconds of turning the strokes of one frame.
    pub solve_secs: f64,
    /// Frames per second.
    pub frames_per_sec: f64,
}

/// Table 2 of the paper.
pub const PAPER_SCENES: [PaperScene; 3] = [
    PaperScene {
        file: "apple",
        object: 1,
        particles: 45_658,
        visible: 327,
        prepare_secs: 0.198,
        solve_secs: 1.65e-3,
        frames_per_sec: 30.75,
    },
    PaperScene {
        file: "fish",
        object: 0,
        particles: 90_213,
        visible: 3562,
        prepare_secs: 1.348,
        solve_secs: 5.56e-3,
        frames_per_sec: 12.60,
    },
    PaperScene {
        file: "simple_objects",
        object: 1,
        particles: 355_467,
        visible: 2137,
        prepare_secs: 4.619,
        solve_secs: 7.22e-3,
        frames_per_sec: 4.73,
    },
];

/// Particles of the paper's largest scene.
pub const LARGEST: usize = PAPER_SCENES[2].particles;

/// The particles of one body as points, in the order in which Impasto stores them.
pub struct Cloud {
    /// Its name in the table of results: the scene's name, or `objects` for clouds of other sizes, and the number of
    /// points.
    pub name: String,
    /// Positions, model space.
    pub positions: Vec<Vec3>,
    /// A unit normal for each position.
    pub normals: Vec<Vec3>,
    /// Area of the surface, model units squared.
    pub area: f64,
}

impl Cloud {
    fn new(name: &str, particles: impl Iterator<Item = impl Borrow<Particle>>, area: f64) -> Self {
        let point = |particle: &Particle| (particle.position, particle.normal);
        let (positions, normals): (Vec<Vec3>, Vec<Vec3>) =
            particles.map(|particle| point(particle.borrow())).unzip();
        Self { name: format!("{name}, {}", shown_count(positions.len())), positions, normals, area }
    }

    /// The radius of a flat piece of the surface that holds `others` points on average.
    pub fn radius_for(&self, others: f64) -> f32 {
        (others * self.area / (std::f64::consts::PI * self.positions.len() as f64)).sqrt() as f32
    }
}

/// The inputs, each made once.
pub struct Inputs {
    root: PathBuf,
    scenes: HashMap<&'static str, Arc<LoadedScene>>,
    paintings: HashMap<&'static str, Painting>,
    clouds: HashMap<String, Rc<Cloud>>,
}

impl Inputs {
    /// The inputs of the repository at this folder.
    pub fn new(root: &Path) -> Self {
        Self {
            root: root.to_path_buf(),
            scenes: HashMap::new(),
            paintings: HashMap::new(),
            clouds: HashMap::new(),
        }
    }

    /// A shipped scene.
    pub fn scene(&mut self, name: &'static str) -> anyhow::Result<Arc<LoadedScene>> {
        if let Some(scene) = self.scenes.get(name) {
            return Ok(Arc::clone(scene));
        }
        let path = self.root.join(format!("scenes/{name}.ron"));
        let loaded = load(&path, &LoadOptions::default()).map_err(|report| anyhow::anyhow!("{report}"))?;
        let loaded = Arc::new(loaded);
        self.scenes.insert(name, Arc::clone(&loaded));
        Ok(loaded)
    }

    /// A shipped scene, prepared.
    pub fn painting(&mut self, name: &'static str) -> anyhow::Result<Painting> {
        if let Some(painting) = self.paintings.get(name) {
            return Ok(painting.clone());
        }
        let painting = impasto_painting::prepare(self.scene(name)?)?;
        self.paintings.insert(name, painting.clone());
        Ok(painting)
    }

    /// The mesh of the paper's largest scene.
    pub fn mesh(&mut self) -> anyhow::Result<TriangleMesh> {
        let scene = self.scene("simple_objects")?;
        let mesh = &scene.scene.objects[PAPER_SCENES[2].object].mesh;
        Ok(scene.meshes.get(mesh).context("the scene has its mesh")?.mesh.clone())
    }

    /// The particles of one of the paper's scenes: those of the body layer, the bulk of the paint.
    pub fn paper_cloud(&mut self, scene: &PaperScene) -> anyhow::Result<Rc<Cloud>> {
        if let Some(cloud) = self.clouds.get(scene.file) {
            return Ok(Rc::clone(cloud));
        }
        let painting = self.painting(scene.file)?;
        let (particles, area) = (painting.particles(scene.object), painting.surface_area(scene.object));
        let cloud = Cloud::new(scene.file, particles.iter(), area);
        anyhow::ensure!(
            cloud.positions.len() == scene.particles,
            "{} has {} particles, where the paper has {}",
            scene.file,
            cloud.positions.len(),
            scene.particles
        );
        let cloud = Rc::new(cloud);
        self.clouds.insert(scene.file.to_owned(), Rc::clone(&cloud));
        Ok(cloud)
    }

    /// `count` particles on the mesh of the paper's largest scene.
    pub fn cloud(&mut self, count: usize) -> anyhow::Result<Rc<Cloud>> {
        if count == LARGEST {
            return self.paper_cloud(&PAPER_SCENES[2]);
        }
        let key = count.to_string();
        if let Some(cloud) = self.clouds.get(&key) {
            return Ok(Rc::clone(cloud));
        }
        let mesh = self.mesh()?;
        let surface = Surface::new(&mesh, |_| true);
        let particles = progressive(&surface, count, 7);
        let cloud = Rc::new(Cloud::new("objects", particles.iter(), surface.area()));
        self.clouds.insert(key, Rc::clone(&cloud));
        Ok(cloud)
    }
}
