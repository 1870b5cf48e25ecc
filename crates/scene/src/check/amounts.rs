//! Checks painted amounts.

use super::regions::{check_object_of, check_radius, names_of_objects};
use super::{Findings, strokes};
use crate::document::{Amount, PaintedAmount, Scene};

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    let object_names = names_of_objects(scene);
    let all = scene.regions.iter().enumerate();
    let all =
        all.flat_map(|(index, region)| region.amounts.iter().enumerate().map(move |of| (index, region, of)));
    for (region_index, region, (index, amount)) in all {
        let path = format!("regions[{region_index}].amounts[{index}]");
        let of = amount.object.as_ref();
        check_object_of(("amount", &path), (scene, &object_names), region, of, findings);
        check_dabs(&path, amount, findings);
        let bends = amount.of == Amount::Flatness && amount.dabs.iter().any(|dab| dab.by < 1.0);
        if let Some(needs) = strokes::needs_flat_strokes(scene).filter(|_| bends) {
            let message = format!("a painted flatness below 1 does not go with {needs}");
            findings.error(format!("{path}.of"), message, "use the solver Tangent, or remove the amount");
        }
    }
}

fn check_dabs(path: &str, amount: &PaintedAmount, findings: &mut Findings) {
    if amount.dabs.is_empty() {
        findings.warning(
            format!("{path}.dabs"),
            "the amount has no dabs and changes nothing",
            "paint it somewhere, or remove it",
        );
    }
    for (index, dab) in amount.dabs.iter().enumerate() {
        let field = |name: &str| format!("{path}.dabs[{index}].{name}");
        findings.vector(&field("at"), dab.at);
        findings.direction(&field("normal"), dab.normal);
        check_radius(&field("radius"), "a dab", dab.radius, findings);
        findings.number(&field("by"), dab.by, amount.of.range());
    }
}
