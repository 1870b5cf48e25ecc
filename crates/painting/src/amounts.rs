//! Painted amounts: how far dabs of a brush make strokes wider, longer, denser and flatter, particle by particle. The
//! amounts depend only on the surface at rest, so they are the same in every view.
//!
//! A dab of radius R that states a factor b multiplies by `1 + (b − 1) w`, with `w = (1 − (r/R)²)² s(n·m)` at a
//! distance r on a surface with the normal n; m is the normal at the dab, and s rises smoothly from 0 at 90° to 1 at
//! 60°. Outside the dab the factor is 1.

use std::collections::HashMap;

use glam::{DVec3, IVec3, Vec3};
use impasto_core::presence::smoothstep;
use impasto_scene::document::{Amount, AmountDab, Scene};

/// A dab has its full strength where the cosine between the two normals is at least this.
const WHOLLY_FACING: f32 = 0.5;

/// The factor on the number of particles is rounded up to one of these. There are few of them, so that particles are
/// seldom sampled again while the user drags a dab.
const COUNT_STEPS: [f32; 13] = [1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 48.0, 64.0];

/// The amounts painted onto one body.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct BodyAmounts {
    of_rule: Vec<RuleAmounts>,
}

/// The amounts painted onto the strokes of one rule (a rule is the settings of one region), in the order of
/// [`Amount::ALL`].
#[derive(Clone, Debug, PartialEq)]
struct RuleAmounts {
    rule: u16,
    dabs: [Dabs; Amount::ALL.len()],
}

/// The dabs of one amount, sorted into cells. A cell lists all dabs that may reach into it, in the order of the file.
#[derive(Clone, Debug, Default, PartialEq)]
struct Dabs {
    dabs: Vec<PlacedDab>,
    cell: f32,
    in_cell: HashMap<IVec3, Vec<u32>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct PlacedDab {
    at: Vec3,
    facing: Vec3,
    radius: f32,
    by: f32,
}

impl BodyAmounts {
    /// The amounts that a scene states for an object.
    pub(crate) fn new(scene: &Scene, object: &str) -> Self {
        let mut all = Self::default();
        for (rule, region) in scene.regions.iter().enumerate() {
            let dabs = Amount::ALL.map(|of| {
                let own = region.amounts.iter().filter(|amount| {
                    amount.of == of && amount.object.as_deref().or(region.on.object()) == Some(object)
                });
                Dabs::new(own.flat_map(|amount| &amount.dabs).map(PlacedDab::of).collect())
            });
            if dabs.iter().any(|dabs| !dabs.dabs.is_empty()) {
                all.of_rule.push(RuleAmounts { rule: rule as u16, dabs });
            }
        }
        all
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.of_rule.is_empty()
    }

    /// The painted factor on width, length, density or flatness at a point of the surface; `rule` is the point's rule.
    pub(crate) fn at(&self, of: Amount, rule: u16, position: Vec3, normal: Vec3) -> f32 {
        let painted = self.of_rule.iter().find(|painted| painted.rule == rule);
        painted.map_or(1.0, |painted| painted.at(of, position, normal))
    }

    /// The painted factors on length, width and density at a point of the surface; `rule` is the point's rule.
    pub(crate) fn painted(&self, rule: u16, position: Vec3, normal: Vec3) -> Painted {
        let painted = self.of_rule.iter().find(|painted| painted.rule == rule);
        painted.map_or(Painted::NOTHING, |painted| painted.painted(position, normal))
    }

    /// The rules onto which anything is painted.
    pub(crate) fn rules(&self) -> impl Iterator<Item = u16> + '_ {
        self.of_rule.iter().map(|painted| painted.rule)
    }

    /// Whether any of these amounts is painted.
    pub(crate) fn has(&self, any: &[Amount]) -> bool {
        self.of_rule.iter().any(|painted| any.iter().any(|&of| !painted.of(of).dabs.is_empty()))
    }

    /// Whether both have the same dabs of flatness. Directions combed by guides depend on these.
    pub(crate) fn same_flatness(&self, other: &Self) -> bool {
        let of = |all: &Self| -> Vec<(u16, Vec<PlacedDab>)> {
            let flat = |painted: &RuleAmounts| (painted.rule, painted.of(Amount::Flatness).dabs.clone());
            all.of_rule.iter().map(flat).filter(|(_, dabs)| !dabs.is_empty()).collect()
        };
        of(self) == of(other)
    }

    /// The factor, at least 1, by which painted amounts raise the number of particles needed: one of [`COUNT_STEPS`].
    pub(crate) fn more_wanted(&self) -> f32 {
        let most = self.of_rule.iter().flat_map(|painted| {
            let sized = [Amount::Width, Amount::Length, Amount::Density];
            let middles = sized.into_iter().flat_map(|of| &painted.of(of).dabs);
            middles.map(|dab| painted.wanted(dab.at, dab.facing))
        });
        let most = most.fold(1.0, f32::max);
        COUNT_STEPS.into_iter().find(|&step| step >= most).unwrap_or(COUNT_STEPS[COUNT_STEPS.len() - 1])
    }
}

impl RuleAmounts {
    fn of(&self, of: Amount) -> &Dabs {
        &self.dabs[of as usize]
    }

    fn at(&self, of: Amount, position: Vec3, normal: Vec3) -> f32 {
        let range = of.range();
        self.of(of).at(position, normal).clamp(*range.start() as f32, *range.end() as f32)
    }

    fn painted(&self, position: Vec3, normal: Vec3) -> Painted {
        let at = |of| self.at(of, position, normal);
        Painted { length: at(Amount::Length), width: at(Amount::Width), density: at(Amount::Density) }
    }

    fn wanted(&self, position: Vec3, normal: Vec3) -> f32 {
        self.painted(position, normal).wanted()
    }
}

impl Dabs {
    fn new(dabs: Vec<PlacedDab>) -> Self {
        // A dab is at most as wide as a cell, so it reaches into few cells.
        let cell = 2.0 * dabs.iter().map(|dab| dab.radius).fold(f32::MIN_POSITIVE, f32::max);
        let mut all = Self { dabs, cell, in_cell: HashMap::new() };
        for (index, dab) in all.dabs.iter().enumerate() {
            let [low, high] = [dab.at - dab.radius, dab.at + dab.radius].map(|at| cell_of(at, cell));
            for x in low.x..=high.x {
                for y in low.y..=high.y {
                    for z in low.z..=high.z {
                        all.in_cell.entry(IVec3::new(x, y, z)).or_default().push(index as u32);
                    }
                }
            }
        }
        all
    }

    fn at(&self, position: Vec3, normal: Vec3) -> f32 {
        if self.dabs.is_empty() {
            return 1.0;
        }
        let near = self.in_cell.get(&cell_of(position, self.cell)).map_or(&[][..], |near| near);
        near.iter().fold(1.0, |product, &dab| product * self.dabs[dab as usize].factor(position, normal))
    }
}

fn cell_of(at: Vec3, cell: f32) -> IVec3 {
    (at / cell).floor().as_ivec3()
}

impl PlacedDab {
    fn of(dab: &AmountDab) -> Self {
        let [at, normal] = [dab.at, dab.normal].map(|v| DVec3::from(v).as_vec3());
        Self {
            at,
            facing: normal.normalize_or(Vec3::Y),
            radius: (dab.radius as f32).max(f32::MIN_POSITIVE),
            by: dab.by as f32,
        }
    }

    fn factor(&self, position: Vec3, normal: Vec3) -> f32 {
        let share = self.at.distance(position) / self.radius;
        if share >= 1.0 {
            return 1.0;
        }
        let falloff = (1.0 - share * share) * (1.0 - share * share);
        1.0 + (self.by - 1.0) * falloff * smoothstep(self.facing.dot(normal) / WHOLLY_FACING)
    }
}

/// The painted factors at one place: on the length and the width of strokes, and on how densely they lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Painted {
    pub(crate) length: f32,
    pub(crate) width: f32,
    pub(crate) density: f32,
}

impl Painted {
    pub(crate) const NOTHING: Self = Self { length: 1.0, width: 1.0, density: 1.0 };

    /// The factor on how many strokes are wanted: the painted density divided by the factor on a stroke's area. With a
    /// density of 1, strokes of the new size cover as much as before.
    pub(crate) fn wanted(self) -> f32 {
        self.density / (self.length * self.width)
    }

    /// The greater of each field.
    pub(crate) fn most(self, other: Self) -> Self {
        Self {
            length: self.length.max(other.length),
            width: self.width.max(other.width),
            density: self.density.max(other.density),
        }
    }
}

/// The flatness of a rule times the painted factor, within 0..=1.
pub(crate) fn painted_flatness(of_rule: f32, by: f32) -> f32 {
    (of_rule * by).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dab(x: f32, radius: f32, by: f32) -> PlacedDab {
        PlacedDab { at: Vec3::new(x, 0.0, 0.0), facing: Vec3::Y, radius, by }
    }

    #[test]
    fn a_dab_has_its_factor_in_the_middle_and_none_outside() {
        let dabs = Dabs::new(vec![dab(0.0, 2.0, 3.0)]);
        let at = |x: f32| dabs.at(Vec3::new(x, 0.0, 0.0), Vec3::Y);
        assert_eq!(at(0.0), 3.0);
        assert_eq!(at(1.0), 1.0 + 2.0 * 0.5625);
        assert_eq!([at(2.0), at(-2.5), at(900.0)], [1.0; 3]);
        let along: Vec<f32> = (0..=40).map(|step| at(step as f32 * 0.05)).collect();
        assert!(along.windows(2).all(|pair| pair[0] > pair[1]), "{along:?}");
        // Its rim has no edge: the last hundredth of the radius changes next to nothing.
        assert!((at(1.98) - 1.0).abs() < 1e-2 && (at(1.998) - 1.0).abs() < 1e-4);
        let turned =
            |deg: f32| dabs.at(Vec3::ZERO, Vec3::new(0.0, deg.to_radians().cos(), deg.to_radians().sin()));
        assert_eq!(turned(59.0), 3.0);
        assert!(turned(75.0) > 1.0 && turned(75.0) < 3.0);
        assert_eq!([turned(90.5), turned(180.0)], [1.0; 2]);
    }

    #[test]
    fn dabs_multiply_wherever_their_cells_are() {
        let dabs: Vec<PlacedDab> = (0..200)
            .map(|i| dab(i as f32 * 0.37 - 30.0, 0.1 + (i % 7) as f32 * 0.4, 0.8 + (i % 3) as f32 * 0.3))
            .collect();
        let all = Dabs::new(dabs.clone());
        for step in 0..2000 {
            let at = Vec3::new(step as f32 * 0.05 - 40.0, 0.2, -0.1);
            let product = dabs.iter().fold(1.0, |product, dab| product * dab.factor(at, Vec3::Y));
            assert_eq!(all.at(at, Vec3::Y), product, "{at}");
        }
        assert_eq!(Dabs::default().at(Vec3::ZERO, Vec3::Y), 1.0);
    }

    #[test]
    fn few_numbers_of_particles_are_asked_for() {
        let of = |of: Amount, by: f32| {
            let mut dabs: [Dabs; 4] = Default::default();
            dabs[of as usize] = Dabs::new(vec![dab(0.0, 1.0, by)]);
            BodyAmounts { of_rule: vec![RuleAmounts { rule: 0, dabs }] }.more_wanted()
        };
        assert_eq!(BodyAmounts::default().more_wanted(), 1.0);
        assert_eq!(
            [of(Amount::Density, 0.0), of(Amount::Density, 1.2), of(Amount::Density, 4.0)],
            [1.0, 1.5, 4.0]
        );
        assert_eq!(
            [of(Amount::Width, 3.0), of(Amount::Width, 0.25), of(Amount::Flatness, 4.0)],
            [1.0, 4.0, 1.0]
        );
    }

    #[test]
    fn cells_list_amounts_in_the_order_of_all() {
        for (index, of) in Amount::ALL.into_iter().enumerate() {
            assert_eq!(of as usize, index);
        }
    }
}
