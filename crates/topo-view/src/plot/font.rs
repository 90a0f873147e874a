//! The typeface that the project ships: Source Sans 3, under the SIL Open Font License.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use resvg::usvg::fontdb::Database;
use std::fmt::Write;
use std::sync::{Arc, LazyLock};

/// Family name, first in every font list.
pub const FAMILY: &str = "Source Sans 3";

/// Value of `font-family`: a name that ends in a number is no identifier, so that browsers drop a list where it stands unquoted.
pub fn list() -> String {
    format!("'{FAMILY}', Arial, sans-serif")
}

const FACES: [&[u8]; 3] = [
    include_bytes!("../../assets/source-sans-3/SourceSans3-Regular.ttf"),
    include_bytes!("../../assets/source-sans-3/SourceSans3-It.ttf"),
    include_bytes!("../../assets/source-sans-3/SourceSans3-Semibold.ttf"),
];

const WEB_FACES: [(&str, &str, &[u8]); 3] = [
    (
        "normal",
        "400",
        include_bytes!("../../assets/source-sans-3/SourceSans3-Regular.woff2"),
    ),
    (
        "italic",
        "400",
        include_bytes!("../../assets/source-sans-3/SourceSans3-It.woff2"),
    ),
    (
        "normal",
        "600",
        include_bytes!("../../assets/source-sans-3/SourceSans3-Semibold.woff2"),
    ),
];

/// Only the shipped faces: nothing is looked up on the machine.
pub fn database() -> Arc<Database> {
    static DATABASE: LazyLock<Arc<Database>> = LazyLock::new(|| {
        let mut db = Database::new();
        for face in FACES {
            db.load_font_data(without_local_forms(face));
        }
        for generic in [Database::set_sans_serif_family, Database::set_serif_family] {
            generic(&mut db, FAMILY);
        }
        Arc::new(db)
    });
    Arc::clone(&DATABASE)
}

/// The face with its `locl` feature renamed to one that nobody asks for.
///
/// It draws Greek Γ and γ as the Latin letters Ɣ and ɣ where the run of text began in Latin script, as our labels do.
fn without_local_forms(face: &[u8]) -> Vec<u8> {
    let mut face = face.to_vec();
    while let Some(at) = face.windows(4).position(|w| w == b"locl") {
        face[at..at + 4].copy_from_slice(b"none");
    }
    face
}

/// `@font-face` rules that make an SVG or HTML page look the same on every machine.
pub fn style() -> &'static str {
    static STYLE: LazyLock<String> = LazyLock::new(|| {
        let mut css = String::new();
        for (style, weight, data) in WEB_FACES {
            // Writing to a string cannot fail.
            let _ = write!(
                css,
                "@font-face{{font-family:'{FAMILY}';font-style:{style};font-weight:{weight};\
                 src:url(data:font/woff2;base64,{})}}",
                base64(data)
            );
        }
        css
    });
    &STYLE
}

/// Base64 with padding.
pub fn base64(data: &[u8]) -> String {
    STANDARD.encode(data)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_the_standard_vectors() {
        for (plain, coded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn three_faces_of_the_family_are_loaded() {
        let db = database();
        assert_eq!(db.len(), 3);
        assert!(
            db.faces()
                .all(|f| f.families.iter().any(|(name, _)| name.starts_with(FAMILY)))
        );
    }
}
