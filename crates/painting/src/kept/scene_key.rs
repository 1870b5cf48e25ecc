//! The key of a scene: a hash of all inputs of the heavy steps of preparing the scene. The inputs are hashed as they
//! are in memory, so it does not matter where the scene's folder lies, or whether a file changes after it was read.
//!
//! Settings are hashed whole, by their `Debug` text. Other structs are destructured here field by field, without
//! `..`: when a field is added, this file does not compile until it says whether the field counts.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DAffine3;
use impasto_core::TriangleMesh;
use impasto_core::bending::{Bend, BendPose, SkinWeights, Target, Vertices};
use impasto_core::shells::Side;
use impasto_scene::document::{Scene, Stage};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::{Points, Texture};
use rayon::prelude::*;

use super::{FORMAT, KeptKey, KeyHasher};
use crate::body::{BodyMaterial, BodySurface};
use crate::body_bend::{BodyBend, BodyCache};
use crate::body_shape::BodyShape;
use crate::context::{Context, ObjectInputs};
use crate::view::PictureView;

/// The inputs of a scene's key.
pub(crate) struct SceneKey<'a> {
    pub(crate) loaded: &'a LoadedScene,
    pub(crate) context: &'a Context<'a>,
    pub(crate) objects: &'a [ObjectInputs<'a>],
    /// The surface of each object.
    pub(crate) surfaces: &'a [Arc<BodySurface>],
}

/// Hashes of things in memory, by their addresses.
type Digests = HashMap<usize, [u8; 32]>;

fn address<T>(of: &Arc<T>) -> usize {
    Arc::as_ptr(of).addr()
}

impl SceneKey<'_> {
    /// The key.
    pub(crate) fn find(&self) -> KeptKey {
        let Self { loaded, context, objects, surfaces } = self;
        let Context { scene, rules, views, seen, shapes, solver, paper, orthographic } = context;
        let mut key = KeyHasher::default();
        key.words(concat!(env!("CARGO_PKG_VERSION"), " ", env!("IMPASTO_SOURCES")));
        key.numbers(&[FORMAT]);
        // The stage, which holds the shot, is left out: what a shot brings is in the objects, and in the views,
        // references and shapes that are hashed below. Touches are left out too, because they are laid anew each time.
        // But the brushes of touches are stored with the kept painting, so the names of these brushes are hashed.
        key.value(&Scene { stage: Stage::default(), touches: Vec::new(), ..Scene::clone(scene) });
        scene.touches.iter().for_each(|touch| key.value(&touch.brush));
        rules.iter().for_each(|rule| key.value(rule));
        key.value(&(solver, paper, orthographic));
        let mut feed = |(view, poses): &(PictureView, Vec<DAffine3>)| {
            key.value(view);
            poses.iter().for_each(|pose| key.numbers(&pose.to_cols_array()));
        };
        views.iter().for_each(&mut feed);
        // `views` is a sample of all views. The others need to be hashed only if a shot or the caller brings them: if
        // not, they follow from the scene.
        let further = if seen.follows_from_scene() { None } else { Some(seen.views()) };
        further.flatten().into_iter().flatten().for_each(&mut feed);
        key.value(&(further.map(|views| views.is_some()), seen.margin()));
        let textures = digests(
            surfaces
                .iter()
                .flat_map(|surface| &surface.materials)
                .filter_map(|material| material.texture.as_ref())
                .chain(loaded.brushes.values()),
            of_texture,
        );
        for (name, picture) in &loaded.brushes {
            key.words(name);
            key.numbers(&textures[&address(picture)]);
        }
        let of_surface = digests(surfaces.iter(), |surface, key| of_surface(surface, &textures, key));
        let of_objects: Vec<[u8; 32]> = objects
            .par_iter()
            .zip(*surfaces)
            .map(|(object, surface)| {
                let mut key = KeyHasher::default();
                key.numbers(&of_surface[&address(surface)]);
                of_object(object, &mut key);
                shapes.iter().for_each(|shapes| of_shape(&shapes[object.index], surface, &mut key));
                // Particles may depend on the shapes in all views. A body with a point cache has its particles
                // everywhere.
                if further.is_some() && surface.bends() && !surface.has_cache() {
                    let shapes = seen.shapes_of(object.index);
                    shapes.iter().flatten().for_each(|shape| of_pose(shape.pose.as_deref(), &mut key));
                    key.value(&shapes.is_some());
                }
                key.finish()
            })
            .collect();
        key.numbers(&of_objects);
        KeptKey(key.finish())
    }
}

/// The hash of each of these; a value that occurs several times is hashed once.
fn digests<'a, T: Send + Sync + 'a>(
    all: impl Iterator<Item = &'a Arc<T>>,
    feed: impl Fn(&T, &mut KeyHasher) + Sync,
) -> Digests {
    let distinct: HashMap<usize, &Arc<T>> = all.map(|one| (address(one), one)).collect();
    let distinct: Vec<&Arc<T>> = distinct.into_values().collect();
    let digest = |one: &&Arc<T>| {
        let mut key = KeyHasher::default();
        feed(one, &mut key);
        key.finish()
    };
    let found: Vec<[u8; 32]> = distinct.par_iter().map(digest).collect();
    distinct.into_iter().map(address).zip(found).collect()
}

fn of_texture(Texture { size_px, rgba8 }: &Texture, key: &mut KeyHasher) {
    key.numbers(size_px);
    key.numbers(rgba8);
}

fn of_surface(surface: &BodySurface, textures: &Digests, key: &mut KeyHasher) {
    let BodySurface { mesh, sides, bending, materials } = surface;
    of_mesh(mesh, key);
    let sides: Vec<u8> = sides
        .iter()
        .map(|side| match side {
            Side::Front => 0,
            Side::Back => 1,
            Side::Both => 2,
        })
        .collect();
    key.numbers(&sides);
    for BodyMaterial { name, albedo, texture, sampler, cutoff, unlit, gloss } in materials {
        key.value(&(name, albedo, sampler, cutoff, unlit, gloss));
        key.numbers(texture.as_ref().map_or(&[][..], |texture| &textures[&address(texture)]));
    }
    // The gradients follow from the other fields. A fault says that the point cache could not be read; then the body
    // stays at rest, as its positions, hashed in `of_shape`, show.
    let BodyBend { bend, cache, rest, gradients: _, fault: _ } = bending;
    if let Some(bend) = bend {
        of_bend(bend, key);
    }
    if let Some(BodyCache { cache: _, points, model_from_file }) = cache {
        // The positions of the cache's points are hashed in `of_shape`, at the frames that matter.
        let Points { count, of_vertex } = &**points;
        key.numbers(&[*count as u64]);
        key.numbers(of_vertex);
        key.numbers(&model_from_file.to_cols_array());
    }
    of_pose(rest.pose.as_deref(), key);
    key.value(&rest.cache_frame);
}

fn of_mesh(mesh: &TriangleMesh, key: &mut KeyHasher) {
    let TriangleMesh {
        positions,
        normals,
        uvs,
        colors,
        triangles,
        polygon_of_triangle,
        group_of_triangle,
        material_of_triangle,
    } = mesh;
    key.numbers(positions);
    key.numbers(normals);
    key.numbers(uvs);
    key.numbers(colors);
    key.numbers(triangles);
    key.numbers(polygon_of_triangle);
    key.numbers(group_of_triangle);
    key.numbers(material_of_triangle);
}

fn of_bend(bend: &Bend, key: &mut KeyHasher) {
    let Bend { bound: Vertices { positions, normals }, targets, skin, rest, turns_normals } = bend;
    key.numbers(positions);
    key.numbers(normals);
    key.numbers(&[targets.len() as u64, u64::from(*turns_normals)]);
    for Target { vertices, positions, normals } in targets {
        key.numbers(vertices);
        key.numbers(positions);
        key.numbers(normals);
    }
    if let Some(SkinWeights { per_vertex, joints, weights }) = skin {
        key.numbers(&[*per_vertex as u64]);
        key.numbers(joints);
        key.numbers(weights);
    }
    of_pose(Some(rest), key);
}

fn of_pose(pose: Option<&BendPose>, key: &mut KeyHasher) {
    key.numbers(&[u8::from(pose.is_some())]);
    if let Some(BendPose { weights, joints }) = pose {
        key.numbers(weights);
        joints.iter().for_each(|joint| key.numbers(&joint.to_cols_array()));
    }
}

/// The shape of an object in a view, without its noise: particles are counted without it.
fn of_shape(shape: &BodyShape, surface: &BodySurface, key: &mut KeyHasher) {
    let BodyShape { pose, cache_frame, noise: _ } = shape;
    of_pose(pose.as_deref(), key);
    let without_noise = BodyShape { noise: None, ..shape.clone() };
    match cache_frame {
        Some(_) => key.numbers(&surface.positions_at(&without_noise)),
        None => key.numbers::<u8>(&[]),
    }
}

fn of_object(object: &ObjectInputs<'_>, key: &mut KeyHasher) {
    // The finished surface is hashed, not its inputs. The groups and the amounts follow from the scene, which is
    // hashed.
    let ObjectInputs { index, groups: _, surface: _, regions, used, guides, amounts: _, references, caps } =
        *object;
    key.numbers(&[index as u64]);
    regions.feed_key(key);
    key.numbers(used);
    guides.iter().for_each(|guide| guide.feed_key(key));
    references.feed_key(key);
    key.value(&caps);
}
