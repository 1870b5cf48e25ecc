//! The difference between two versions of a scene, compact and applicable in both directions. It is what an entry of
//! the history stores about the scene.

use impasto_scene::document::{AmountDab, Guide, Object, PaintedAmount, Region, Scene, Touch};

#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SceneChange {
    parts: Vec<Part>,
}

#[derive(Clone, Debug, PartialEq)]
enum Part {
    /// Everything but objects, regions and touches.
    Head(Box<[Scene; 2]>),
    Objects(Splice<Object>),
    Regions(Splice<Region>),
    Touches(Splice<Touch>),
    /// The guides of one region, where nothing else of any region differs.
    Guides(usize, Splice<Guide>),
    /// The painted amounts of one region, where nothing else of any region differs.
    Amounts(usize, Splice<PaintedAmount>),
    /// The dabs of one amount of one region, where nothing else of any region differs.
    Dabs([usize; 2], Splice<AmountDab>),
}

/// A run of a list and the run that replaces it.
#[derive(Clone, Debug, PartialEq)]
struct Splice<T> {
    at: usize,
    before: Vec<T>,
    after: Vec<T>,
}

impl<T: Clone + PartialEq> Splice<T> {
    fn between(before: &[T], after: &[T]) -> Option<Self> {
        if before == after {
            return None;
        }
        let at = before.iter().zip(after).take_while(|(a, b)| a == b).count();
        let (left, right) = (&before[at..], &after[at..]);
        let tail = left.iter().rev().zip(right.iter().rev()).take_while(|(a, b)| a == b).count();
        let middle = |list: &[T]| list[..list.len() - tail].to_vec();
        Some(Self { at, before: middle(left), after: middle(right) })
    }

    fn forward(&self, list: &mut Vec<T>) {
        list.splice(self.at..self.at + self.before.len(), self.after.iter().cloned());
    }

    fn backward(&self, list: &mut Vec<T>) {
        list.splice(self.at..self.at + self.after.len(), self.before.iter().cloned());
    }
}

impl SceneChange {
    /// None where nothing differs.
    pub(crate) fn between(before: &Scene, after: &Scene) -> Option<Self> {
        let mut parts = Vec::new();
        let heads = [head(before), head(after)];
        if heads[0] != heads[1] {
            parts.push(Part::Head(Box::new(heads)));
        }
        parts.extend(Splice::between(&before.objects, &after.objects).map(Part::Objects));
        parts.extend(regions(&before.regions, &after.regions));
        parts.extend(Splice::between(&before.touches, &after.touches).map(Part::Touches));
        (!parts.is_empty()).then_some(Self { parts })
    }

    pub(crate) fn redo(&self, scene: &mut Scene) {
        for part in &self.parts {
            match part {
                Part::Head(heads) => put_head(scene, &heads[1]),
                Part::Objects(splice) => splice.forward(&mut scene.objects),
                Part::Regions(splice) => splice.forward(&mut scene.regions),
                Part::Touches(splice) => splice.forward(&mut scene.touches),
                Part::Guides(region, splice) => splice.forward(&mut scene.regions[*region].guides),
                Part::Amounts(region, splice) => splice.forward(&mut scene.regions[*region].amounts),
                Part::Dabs([region, amount], splice) => {
                    splice.forward(&mut scene.regions[*region].amounts[*amount].dabs);
                }
            }
        }
    }

    pub(crate) fn undo(&self, scene: &mut Scene) {
        for part in &self.parts {
            match part {
                Part::Head(heads) => put_head(scene, &heads[0]),
                Part::Objects(splice) => splice.backward(&mut scene.objects),
                Part::Regions(splice) => splice.backward(&mut scene.regions),
                Part::Touches(splice) => splice.backward(&mut scene.touches),
                Part::Guides(region, splice) => splice.backward(&mut scene.regions[*region].guides),
                Part::Amounts(region, splice) => splice.backward(&mut scene.regions[*region].amounts),
                Part::Dabs([region, amount], splice) => {
                    splice.backward(&mut scene.regions[*region].amounts[*amount].dabs);
                }
            }
        }
    }

    /// An estimate of its memory, bytes.
    pub(crate) fn bytes(&self) -> usize {
        let of_guides =
            |guides: &[Guide]| guides.iter().map(|guide| 96 + guide.points.len() * 56).sum::<usize>();
        let of_dabs = |dabs: &[AmountDab]| size_of_val(dabs);
        let of_amounts = |amounts: &[PaintedAmount]| {
            amounts.iter().map(|amount| 64 + of_dabs(&amount.dabs)).sum::<usize>()
        };
        let of_region = |region: &Region| 512 + of_guides(&region.guides) + of_amounts(&region.amounts);
        let of_regions = |regions: &[Region]| regions.iter().map(of_region).sum::<usize>();
        let of_objects =
            |objects: &[Object]| objects.iter().map(|object| 256 + object.keys.len() * 80).sum::<usize>();
        let of_touches = |touches: &[Touch]| {
            touches.iter().map(|touch| 192 + size_of_val(&touch.points[..])).sum::<usize>()
        };
        let of_part = |part: &Part| match part {
            Part::Head(_) => 4096,
            Part::Objects(splice) => of_objects(&splice.before) + of_objects(&splice.after),
            Part::Regions(splice) => of_regions(&splice.before) + of_regions(&splice.after),
            Part::Touches(splice) => of_touches(&splice.before) + of_touches(&splice.after),
            Part::Guides(_, splice) => of_guides(&splice.before) + of_guides(&splice.after),
            Part::Amounts(_, splice) => of_amounts(&splice.before) + of_amounts(&splice.after),
            Part::Dabs(_, splice) => of_dabs(&splice.before) + of_dabs(&splice.after),
        };
        self.parts.iter().map(of_part).sum()
    }
}

/// A scene without its objects, regions and touches.
pub(crate) fn head(scene: &Scene) -> Scene {
    Scene {
        version: scene.version,
        size: scene.size,
        seed: scene.seed,
        background: scene.background,
        background_keys: scene.background_keys.clone(),
        shot: scene.shot.clone(),
        stage: scene.stage.clone(),
        timeline: scene.timeline.clone(),
        exposure: scene.exposure,
        reference: scene.reference.clone(),
        further_references: scene.further_references.clone(),
        camera: scene.camera.clone(),
        lights: scene.lights.clone(),
        objects: Vec::new(),
        strokes: scene.strokes.clone(),
        regions: Vec::new(),
        touches: Vec::new(),
        style: scene.style.clone(),
        aovs: scene.aovs.clone(),
    }
}

fn put_head(scene: &mut Scene, head: &Scene) {
    let (objects, regions) = (std::mem::take(&mut scene.objects), std::mem::take(&mut scene.regions));
    let touches = std::mem::take(&mut scene.touches);
    *scene = Scene { objects, regions, touches, ..head.clone() };
}

fn regions(before: &[Region], after: &[Region]) -> Option<Part> {
    let splice = Splice::between(before, after)?;
    if let ([one], [other]) = (&splice.before[..], &splice.after[..]) {
        let bare = |region: &Region| Region { guides: Vec::new(), amounts: Vec::new(), ..region.clone() };
        if bare(one) == bare(other) && one.amounts == other.amounts {
            return Splice::between(&one.guides, &other.guides).map(|guides| Part::Guides(splice.at, guides));
        }
        if bare(one) == bare(other) && one.guides == other.guides {
            return amounts(splice.at, [&one.amounts, &other.amounts]);
        }
    }
    Some(Part::Regions(splice))
}

/// What differs in the amounts of a region: usually one list of dabs.
fn amounts(region: usize, [before, after]: [&[PaintedAmount]; 2]) -> Option<Part> {
    let splice = Splice::between(before, after)?;
    if let ([one], [other]) = (&splice.before[..], &splice.after[..])
        && (one.of, &one.object) == (other.of, &other.object)
    {
        return Splice::between(&one.dabs, &other.dabs).map(|dabs| Part::Dabs([region, splice.at], dabs));
    }
    Some(Part::Amounts(region, splice))
}
