//! Quotes text for shells and for YAML.

/// A text as a word of a shell command: unchanged if it holds nothing special, else in quotes.
pub(crate) fn of_shell(text: &str) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "/._-+:,=@%#".contains(letter);
    if !text.is_empty() && text.chars().all(is_plain) && !text.starts_with('#') {
        text.to_owned()
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

/// A YAML string. Every JSON string is one.
pub(crate) fn of_yaml(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shell_gives_every_word_back() {
        for word in ["out/f_####.png", "it's", "a b", "", "$HOME", "#x", "línea;rm -rf *", "a\nb"] {
            let script = format!("printf %s {}", of_shell(word));
            let said = std::process::Command::new("sh").args(["-c", &script]).output().unwrap();
            assert_eq!(String::from_utf8(said.stdout).unwrap(), word);
        }
    }
}
