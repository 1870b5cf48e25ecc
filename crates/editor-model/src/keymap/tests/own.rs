//! Tests of keys that the user chose: which commands lose keys to them and get them back, and keys as text.

use super::*;

fn id(name: &str) -> CommandId {
    CommandId::named(name).unwrap_or_else(|| panic!("no command is called {name}"))
}

fn with(keymap: &Keymap, name: &str, keys: &[&str]) -> Keymap {
    keymap.with(id(name), keys.iter().map(|key| chord(key)).collect())
}

fn keys(keymap: &Keymap, name: &str) -> Vec<String> {
    let found = keymap.commands().find(|command| command.id == id(name));
    found.unwrap().chords.iter().map(Chord::text).collect()
}

fn changed(keymap: &Keymap) -> Vec<String> {
    keymap.commands().filter(|command| command.is_changed).map(|command| command.id.name()).collect()
}

#[test]
fn every_command_has_a_name_of_its_own_and_every_key_its_words() {
    for keymap in keymaps() {
        for command in keymap.commands() {
            assert_eq!(CommandId::named(&command.id.name()), Some(command.id));
            for own in command.chords {
                assert_eq!(own.text().parse(), Ok(own));
            }
        }
    }
    assert_eq!(chord("Ctrl k"), chord("Ctrl K"));
    assert_eq!(chord("Shift F35").key, Key::Function(35));
    for text in ["", "Ctrl", "Ctrl Banana", "F36", "F0", "NumPad 10", "Meta K", "é", "12", "Fé"] {
        assert!(text.parse::<Chord>().is_err(), "{text}");
    }
}

#[test]
fn a_key_of_ones_own_is_the_only_one_and_shows_everywhere() {
    let own = with(&BLENDER, "Comb", &["Ctrl K"]);
    assert_eq!(does(&own, "Ctrl K", Scope::Paint), Some(Action::Comb));
    assert_eq!(does(&own, "C", Scope::Paint), None);
    assert_eq!(own.shortcut_text(Action::Comb).as_deref(), Some("Ctrl K"));
    assert!(own.listed().any(|line| line.action == Action::Comb && line.keys == "Ctrl K"));
    assert_eq!(changed(&own), ["Comb"]);
    // The choice holds with the other preset, too.
    let maya = Keymap { preset: Preset::Maya, ..own };
    assert_eq!(does(&maya, "Ctrl K", Scope::Paint), Some(Action::Comb));
}

#[test]
fn a_key_that_is_taken_comes_back() {
    assert_eq!(BLENDER.losers(id("Comb"), &[chord("K")]), [id("Compare with the reference")]);
    assert_eq!(BLENDER.losers(id("Comb"), &[chord("Ctrl K")]), []);
    let own = with(&BLENDER, "Comb", &["K"]);
    assert_eq!(does(&own, "K", Scope::Paint), Some(Action::Comb));
    assert_eq!(does(&own, "K", Scope::Arrange), None, "Comb took K from Compare in all modes");
    assert_eq!(changed(&own), ["Comb", "Compare with the reference"]);
    assert_eq!(own.own.iter().count(), 1, "only what was chosen is kept");
    assert_eq!(with(&own, "Comb", &["C"]), *BLENDER);
    // The other way round: Compare takes its key back, and Comb, which had taken it, has none.
    let back = with(&own, "Compare with the reference", &["K"]);
    assert_eq!(does(&back, "K", Scope::Paint), Some(Action::Compare));
    assert_eq!(keys(&back, "Comb"), Vec::<String>::new());
    assert_eq!(changed(&back), ["Comb"]);
}

#[test]
fn a_swap_stays_a_swap() {
    let own = with(&with(&BLENDER, "Comb", &["S"]), "Smooth", &["C"]);
    assert_eq!(does(&own, "S", Scope::Paint), Some(Action::Comb));
    assert_eq!(does(&own, "C", Scope::Paint), Some(Action::Smooth));
    assert_eq!(does(&own, "S", Scope::Arrange), Some(Action::Scale), "S still scales in Arrange");
    assert_eq!(with(&with(&own, "Comb", &["C"]), "Smooth", &["S"]), *BLENDER);
}

#[test]
fn what_is_modal_takes_no_key_from_others() {
    assert_eq!(BLENDER.losers(id("Along X"), &[chord("K")]), []);
    assert_eq!(BLENDER.losers(id("Along X"), &[chord("Y")]), [id("Along Y")]);
    assert_eq!(BLENDER.losers(id("Delete (keys on a lane)"), &[chord("K")]), []);
    let own = with(&BLENDER, "Along X", &["K"]);
    assert_eq!(does(&own, "K", Scope::Transform), Some(Action::HoldAxis(Axis::X)));
    assert_eq!(does(&own, "K", Scope::Arrange), Some(Action::Compare));
}

#[test]
fn no_choice_of_keys_makes_a_key_do_two_things() {
    // Every command in turn takes the key of another one.
    for keymap in keymaps() {
        let commands: Vec<CommandKeys> = keymap.commands().collect();
        let mut own = keymap.clone();
        for (index, command) in commands.iter().enumerate() {
            let other = &commands[(index * 37 + 11) % commands.len()];
            let works = other.chords.iter().all(|chord| command.id.refusal(*chord).is_none());
            if works && command.id.is_free() && other.id.is_free() && !other.chords.is_empty() {
                own = own.with(command.id, other.chords.clone());
                assert_eq!(own.losers(command.id, &other.chords), []);
            }
        }
        let all: Vec<CommandKeys> = own.commands().collect();
        for command in &all {
            assert_eq!(own.losers(command.id, &command.chords), [], "{}", command.id.name());
        }
        assert_eq!(does(&own, "Esc", Scope::Drawing), Some(Action::Cancel));
        let back = Keymap { own: OwnKeys::default(), ..own };
        assert_eq!(back, keymap);
    }
}

#[test]
fn escape_stays_what_cancels() {
    let mut own = OwnKeys::default();
    own.note(id("Comb"), vec![chord("Esc"), chord("K")]);
    own.note(id("Cancel"), vec![chord("Q")]);
    let keymap = Keymap { own, ..Keymap::default() };
    assert_eq!(keys(&keymap, "Comb"), ["K"]);
    assert_eq!(keys(&keymap, "Cancel"), ["Esc"]);
}

#[test]
fn a_choice_outlasts_a_preset_that_has_the_same_keys() {
    // In Maya's preset Brush radius is on B anyway, so this choice differs from Blender's preset only.
    let own = with(&BLENDER, "Brush radius", &["B"]);
    let maya = Keymap { preset: Preset::Maya, ..own.clone() };
    let own = Keymap { preset: Preset::Blender, ..with(&maya, "Comb", &["Ctrl K"]) };
    assert_eq!(keys(&own, "Brush radius"), ["B"], "a change of another command takes nothing away");
    assert_eq!(keys(&own, "Comb"), ["Ctrl K"]);
    let own = with(&own, "Comb", &["C"]);
    assert_eq!(own.own.iter().map(|(id, _)| id.name()).collect::<Vec<_>>(), ["Brush radius"]);
}

#[test]
fn keys_that_cannot_work_are_refused() {
    for (name, key, works) in [
        ("Along X", "7", false),
        ("Along X", "NumPad 7", false),
        ("Along X", "Shift -", false),
        ("Along X", ".", false),
        ("Along X", "Ctrl 7", true),
        ("Keep", ",", false),
        ("Keep", "K", true),
        ("Read the source again", "K", false),
        ("Read the source again", "Alt K", false),
        ("Read the source again", "F7", true),
        ("Read the source again", "Ctrl K", true),
        ("Comb", "7", true),
        ("Comb", "Shift Esc", false),
        ("Cancel", "K", false),
    ] {
        assert_eq!(id(name).refusal(chord(key)).is_none(), works, "{name} {key}");
        let own = with(&BLENDER, name, &[key]);
        assert_eq!(keys(&own, name) == [key], works, "{name} {key}");
        assert!(works || own == *BLENDER, "{name} {key}");
    }
    // No preset gives a command a key that the command refuses.
    for keymap in keymaps() {
        for command in keymap.commands().filter(|command| command.id.is_free()) {
            assert!(command.chords.iter().all(|chord| command.id.refusal(*chord).is_none()));
        }
    }
}

#[test]
fn a_key_on_a_lane_hides_what_it_does_elsewhere() {
    let delete = id("Delete (keys on a lane)");
    assert_eq!(BLENDER.hidden(delete, &[chord("K")]), [id("Compare with the reference")]);
    assert_eq!(BLENDER.hidden(delete, &[chord("V")]), [], "Guide curve has this key in Paint only");
    assert_eq!(BLENDER.hidden(id("Along X"), &[chord("K")]), []);
}

#[test]
fn hints_name_the_keys_in_use() {
    let hints = "[Drag] comb  [F] radius  [Middle] orbit";
    assert_eq!(BLENDER.in_own_keys(hints), hints);
    assert_eq!(MAYA.in_own_keys(hints), "[Drag] comb  [B] radius  [Alt Drag] orbit");
    let maya = MAYA.in_own_keys("Move a [I] [b  [G R S] move, turn, scale  [I] key");
    assert_eq!(maya, "Move a [I] [b  [W E R] move, turn, scale  [S] key");
    let own = with(&BLENDER, "Brush radius", &["Alt B"]);
    assert_eq!(own.in_own_keys(hints), "[Drag] comb  [Alt B] radius  [Middle] orbit");
    let none = with(&BLENDER, "Brush radius", &[]);
    assert_eq!(none.in_own_keys(hints), "[Drag] comb  [Middle] orbit");
}
