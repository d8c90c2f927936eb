//! What the program says, compared with files that hold it word for word.
//!
//! They are rewritten when `DRIPFEED_BLESS=1` is set, and then the difference is to be looked at.

use std::path::Path;

/// Compares what was said with the file of a name under `tests/golden`, `messages/words-none.txt` for one; tells both where
/// they differ. The system's error numbers are written `N`.
pub(crate) fn difference(name: &str, said: &str) -> Option<String> {
    let said = without_error_numbers(said);
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if std::env::var("DRIPFEED_BLESS").is_ok_and(|value| value == "1") {
        std::fs::write(&file, &said).expect("a golden file can be written");
    }
    let golden = std::fs::read_to_string(&file).unwrap_or_else(|wrong| format!("({wrong})\n"));
    (said != golden).then(|| format!("--- golden {name}\n{golden}--- said\n{said}"))
}

/// System error numbers differ from system to system.
fn without_error_numbers(text: &str) -> String {
    let mut parts = text.split("(os error ");
    let mut normal = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        normal.push_str("(os error N");
        normal.push_str(part.trim_start_matches(|c: char| c.is_ascii_digit()));
    }
    normal
}
