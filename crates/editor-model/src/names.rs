//! Names of things: making them unique, and renaming a thing wherever the document refers to it.

use impasto_scene::document::{Scene, Selector};

use crate::refusal::Refusal;

/// The wanted name if it is not in `taken`. If it is, the first numbered name that is free: `apple 2`, `apple 3`.
pub(crate) fn unique<'a>(wanted: &str, taken: impl Iterator<Item = &'a str> + Clone) -> String {
    let is_free = |name: &str| taken.clone().all(|other| other != name);
    if is_free(wanted) {
        return wanted.to_owned();
    }
    let digits = wanted.len() - wanted.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    let stem = match wanted[..wanted.len() - digits].strip_suffix(' ') {
        Some(stem) if digits > 0 => stem,
        _ => wanted,
    };
    (2_u64..).map(|number| format!("{stem} {number}")).find(|name| is_free(name)).unwrap_or_default()
}

/// A name that a person typed, trimmed.
pub(crate) fn typed(name: &str) -> Result<String, Refusal> {
    let name = name.trim();
    if name.is_empty() {
        return Err(Refusal::new("A name has at least one letter"));
    }
    if name.len() > impasto_scene::limits::MAX_NAME_BYTES || name.chars().any(char::is_control) {
        return Err(Refusal::new("That name is too long, or holds characters that do not show"));
    }
    Ok(name.to_owned())
}

pub(crate) fn rename_object(scene: &mut Scene, old: &str, new: &str) {
    for object in &mut scene.objects {
        if object.name == old {
            new.clone_into(&mut object.name);
        }
        if object.parent.as_deref() == Some(old) {
            object.parent = Some(new.to_owned());
        }
    }
    for touch in scene.touches.iter_mut().filter(|touch| touch.on == old) {
        new.clone_into(&mut touch.on);
    }
    for region in &mut scene.regions {
        rename_in(&mut region.on, old, new);
        let of_guides = region.guides.iter_mut().map(|guide| &mut guide.object);
        let of_amounts = region.amounts.iter_mut().map(|amount| &mut amount.object);
        for object in of_guides.chain(of_amounts).filter(|object| object.as_deref() == Some(old)) {
            *object = Some(new.to_owned());
        }
    }
}

fn rename_in(selector: &mut Selector, old: &str, new: &str) {
    match selector {
        Selector::Everything | Selector::Collection(_) | Selector::EachMaterial(_) => {}
        Selector::Object(name)
        | Selector::Group(name, _)
        | Selector::Material(name, _)
        | Selector::Dabs(name, _)
        | Selector::Flood(name, ..)
        | Selector::Several(name, _) => {
            if name == old {
                new.clone_into(name);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_go_up_and_do_not_pile_up() {
        let taken = ["apple", "apple 2", "7"];
        assert_eq!(unique("pear", taken.into_iter()), "pear");
        assert_eq!(unique("apple", taken.into_iter()), "apple 3");
        assert_eq!(unique("apple 2", taken.into_iter()), "apple 3");
        assert_eq!(unique("7", taken.into_iter()), "7 2");
    }
}
