use super::*;
use crate::V;
use crate::closed_braid;
use topo_core::Polyline;

use CurveFormat::{Csv, Vect, Xyz};

fn parse(text: impl AsRef<[u8]>, format: CurveFormat) -> Result<CurveFile, KnotError> {
    CurveFile::parse(Path::new("curve"), text.as_ref(), format, FrameChoice::Only)
}

fn refusal(text: impl AsRef<[u8]>, format: CurveFormat) -> String {
    parse(text, format).expect_err("refused").to_string()
}

/// The six vertices of a trefoil made of straight sticks.
const TREFOIL: [[i32; 3]; 6] = [
    [-2, 2, 1],
    [4, 0, 3],
    [-4, -4, -4],
    [1, 3, 3],
    [3, 0, 3],
    [0, 2, 0],
];

/// A line for each vertex of the trefoil.
fn lines(line: impl Fn(usize, [i32; 3]) -> String) -> String {
    TREFOIL
        .iter()
        .enumerate()
        .map(|(k, x)| line(k, *x) + "\n")
        .collect()
}

fn vertices() -> Vec<V> {
    TREFOIL.iter().map(|x| V::from(x.map(f64::from))).collect()
}

/// The same bytes in UTF-16, little-endian or big-endian.
fn utf16(text: &str, little: bool) -> Vec<u8> {
    let bytes = |unit: u16| {
        if little {
            unit.to_le_bytes()
        } else {
            unit.to_be_bytes()
        }
    };
    text.encode_utf16().flat_map(bytes).collect()
}

#[test]
fn components_come_back_to_the_bit() {
    let curves = crate::braid_closure(&[1, -2, 1, -2, 1, -2]).expect("a link");
    for (format, name) in [
        (CurveFormat::Csv, "link.csv"),
        (CurveFormat::Xyz, "link.xyz"),
        (CurveFormat::Vect, "link.vect"),
    ] {
        let text = curves_text(&curves, format);
        let read = parse_components(Path::new(name), &text, format).expect("components");
        assert_eq!(read.len(), 3, "{name}");
        for (component, curve) in read.iter().zip(&curves) {
            assert_eq!(component.vertices, curve.vertices(), "{name}");
            assert!(component.is_closed(), "{name}");
        }
    }
}

#[test]
fn curves_survive_every_format() {
    let closed = closed_braid(&[1, 1, 1]).expect("a knot");
    let open = Polyline::new(closed.vertices()[..40].to_vec(), false).expect("a chain");
    let folder = std::env::temp_dir().join(format!("topo-knots-curves-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("folder");
    for curve in [&closed, &open] {
        for name in ["c.csv", "c.xyz", "c.vect", "c.VECT"] {
            let path = folder.join(name);
            write_curve(&path, curve).expect("written");
            let found = read_curve(&path).expect("read");
            assert_eq!(found.vertices, curve.vertices(), "{name}");
            let is_vect = name.to_ascii_lowercase().ends_with("vect");
            assert_eq!(found.closed, is_vect.then_some(curve.is_closed()));
            assert_eq!(found.is_closed(), curve.is_closed(), "{name}");
        }
    }
    let is_folder = read_curve(&folder).expect_err("a folder").to_string();
    assert!(is_folder.contains("this is a folder"), "{is_folder}");
    std::fs::write(folder.join("c.obj"), "0 0 0").expect("written");
    let unknown = read_curve(&folder.join("c.obj"))
        .expect_err("unknown")
        .to_string();
    assert!(unknown.contains("extension tells no format"), "{unknown}");
    let missing = read_curve(&folder.join("d.csv"))
        .expect_err("another name")
        .to_string();
    assert!(
        missing.contains("no such file; did you mean `c.csv`?"),
        "{missing}"
    );
    std::fs::remove_dir_all(&folder).expect("removed");
}

/// A file and its format.
type File<T> = (T, CurveFormat);

fn csv_rows() -> String {
    lines(|_, [x, y, z]| format!("{x},{y},{z}"))
}

fn xyz_rows() -> String {
    lines(|_, [x, y, z]| format!("{x} {y} {z}"))
}

/// A text with every end of line and in every encoding.
fn encodings(text: &str, format: CurveFormat) -> Vec<File<Vec<u8>>> {
    let mut texts = Vec::new();
    for end in ["\r\n", "\r", "\r\r\n"] {
        texts.push((text.replace('\n', end).into_bytes(), format));
    }
    texts.push((format!("\u{feff}{text}").into_bytes(), format));
    texts.push((format!("\u{feff}\u{feff}{text}").into_bytes(), format));
    texts.push((text.trim_end().as_bytes().to_vec(), format));
    texts.push((format!("{text}\u{1a}").into_bytes(), format));
    for little in [true, false] {
        texts.push((utf16(&format!("\u{feff}{text}"), little), format));
        texts.push((utf16(text, little), format));
    }
    let remark = if format == Vect { "VECT #" } else { "#" };
    let rest = text.strip_prefix("VECT").unwrap_or(text);
    let latin1 = [remark.as_bytes(), b" f\xfcr den Knoten\n", rest.as_bytes()].concat();
    texts.push((latin1, format));
    texts
}

/// Headers, separators and quotes.
fn csv_files() -> Vec<File<String>> {
    let rows = csv_rows();
    let csv = format!("x,y,z\n{rows}");
    vec![
        (format!("# x,y,z\n{rows}"), Csv),
        (format!("# made by hand\n# x y z\n# x: along\n{rows}"), Csv),
        (
            format!(
                "#,x,y,z\n{}",
                lines(|k, [x, y, z]| format!("{k},{x},{y},{z}"))
            ),
            Csv,
        ),
        (
            format!(
                ",x,y,z\n{}",
                lines(|k, [x, y, z]| format!("{k},{x},{y},{z}"))
            ),
            Csv,
        ),
        (rows.clone(), Csv),
        (
            format!(
                "# z [h] x y speed\n{}",
                lines(|k, [x, y, z]| format!("{z} {x} {y} 0.{k}"))
            ),
            Xyz,
        ),
        (csv.replace(',', ";"), Csv),
        (csv.replace(',', "\t"), Csv),
        (
            format!(
                "\"z [h]\",\"X\",y (h),t\n{}",
                lines(|k, [x, y, z]| format!("{z},{x},{y},{k}"))
            ),
            Csv,
        ),
        (
            format!(
                "x,y,z\n{}",
                lines(|_, x| x.map(|c| format!("\"{c}.0\"")).join(","))
            ),
            Csv,
        ),
    ]
}

/// Columns, exponents, signs, titles, extended XYZ and a repeated first vertex.
fn xyz_files() -> Vec<File<String>> {
    let xyz = xyz_rows();
    let csv = format!("x,y,z\n{}", csv_rows());
    vec![
        (csv, Xyz),
        (lines(|k, [x, y, z]| format!("{} {x} {y} {z}", k + 1)), Xyz),
        (lines(|k, [x, y, z]| format!("{x} {y} {z} {k}")), Xyz),
        (lines(|_, x| x.map(|c| format!("{c}.0D+00")).join(" ")), Xyz),
        (lines(|_, x| x.map(|c| format!("{c}0d-1")).join("\t")), Xyz),
        (
            lines(|_, x| x.map(|c| c.to_string().replace('-', "\u{2212}")).join(" ")),
            Xyz,
        ),
        (
            format!(
                "6\ntitle\n{}",
                lines(|_, [x, y, z]| format!("C {x} {y} {z}"))
            ),
            Xyz,
        ),
        (
            format!(
                "6\n\n{}\n\n",
                lines(|_, [x, y, z]| format!("C {x} {y} {z} 0.5 {x}"))
            ),
            Xyz,
        ),
        (
            format!(
                "6\nx y z energy\n{}",
                lines(|_, [x, y, z]| format!("{x} {y} {z} 7"))
            ),
            Xyz,
        ),
        (format!("6\n{xyz}"), Xyz),
        (
            format!(
                "6\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:forces:R:3:pos:R:3 pbc=\"T T T\"\n{}",
                lines(|_, [x, y, z]| format!("C 1 0 0 {x} {y} {z}"))
            ),
            Xyz,
        ),
        (format!("{xyz}-2 2 1\n"), Xyz),
    ]
}

#[test]
fn files_as_people_have_them() {
    let xyz = xyz_rows();
    let csv = format!("x,y,z\n{}", csv_rows());
    let vect = format!("VECT\n1 6 0\n-6\n0\n{xyz}");
    let mut texts: Vec<File<Vec<u8>>> = Vec::new();
    for (text, format) in [(&xyz, Xyz), (&csv, Csv), (&vect, Vect)] {
        texts.extend(encodings(text, format));
    }
    let files = csv_files().into_iter().chain(xyz_files());
    texts.extend(files.map(|(text, format)| (text.into_bytes(), format)));
    for (text, format) in texts {
        let shown = String::from_utf8_lossy(&text).into_owned();
        let file = parse(&text, format).unwrap_or_else(|e| panic!("{e}: {shown}"));
        assert_eq!(file.components.len(), 1, "{shown}");
        assert_eq!(file.components[0].vertices, vertices(), "{shown}");
        assert!(
            file.components[0].is_closed() && file.frame.is_none(),
            "{shown}"
        );
    }
}

#[test]
fn what_was_concluded_is_said() {
    let notes = |text: &[u8], format| parse(text, format).expect("read").notes.join("; ");
    assert!(
        notes(b"0 0 0 # \xe9\n1 0 0\n0 1 0\n", Xyz).contains("line 1: the byte 0xe9 is not UTF-8")
    );
    assert!(notes(&utf16("0 0 0\n1 0 0\n", true), Xyz).contains("UTF-16"));
    assert!(notes(b"1 0 0 0\n2 1 0 0\n3 1 1 0\n", Xyz).contains("column 1 counts"));
    assert!(notes(b"x,y,z,charge\n0,0,0,1\n1,0,0,2\n", Csv).contains("`charge`"));
    assert!(notes(b"C 0 0 0 1\nC 1 0 0 2\n", Xyz).contains("columns 5 to 5"));
    assert_eq!(notes(b"0 0 0\n1 0 0\n", Xyz), "");
}

#[test]
fn components_are_kept_apart() {
    let two = lines(|k, [x, y, z]| format!("{x} {y} {z}{}", if k == 2 { "\nBREAK" } else { "" }));
    for mark in ["", "\n", "NaN NaN NaN", "nan -nan nan", "X", "TER"] {
        let file = parse(two.replace("BREAK", mark), Xyz).expect("two");
        let sizes: Vec<usize> = file.components.iter().map(|c| c.vertices.len()).collect();
        assert_eq!(sizes, [3, 3], "{mark:?}");
    }
    let column = lines(|k, [x, y, z]| format!("{},{x},{y},{z}", if k < 3 { "a" } else { "b" }));
    for header in ["component,x,y,z", "Line,x,y,z", "chain,x,y,z"] {
        let file = parse(format!("{header}\n{column}"), Csv).expect("two");
        assert_eq!(file.components.len(), 2, "{header}");
    }
    let hidden = refusal(format!("kind,x,y,z\n{column}"), Csv);
    assert!(
        hidden.contains("line 5: column `kind` turns to `b`"),
        "{hidden}"
    );
    let back = refusal(
        "line,x,y,z\n0,0,0,0\n0,1,0,0\n1,5,5,5\n1,6,5,5\n0,1,1,0\n",
        Csv,
    );
    assert!(
        back.contains("line 6: a component goes on here that ended before"),
        "{back}"
    );
    let vect = "VECT # a comment\n2 7 1\n-3 4\n1 0\n0 0 0  1 0 0\n0 1 0\n 5 5 5 6 5 5 6 6 5 6 6 6\n1 0 0 1\n";
    let found = parse(vect, Vect).expect("two components").components;
    assert_eq!(
        (found[0].closed, found[1].closed),
        (Some(true), Some(false))
    );
    assert!(matches!(
        only(Path::new("c"), found),
        Err(KnotError::Link { n_components: 2 })
    ));
    let restarted = "1 0 0 0\n2 1 0 0\n3 1 1 0\n\n1 5 5 5\n2 6 5 5\n3 6 6 5\n";
    assert_eq!(parse(restarted, Xyz).expect("two").components.len(), 2);
}

#[test]
fn frames_are_chosen() {
    let molecular =
        "3\nfirst\nC 0 0 0\nC 1 0 0\nC 1 1 0\n\n4\nsecond\nC 5 0 0\nC 6 0 0\nC 6 1 0\nC 5 1 0\n";
    let bare = "3\n0 0 0\n1 0 0\n1 1 0\n4\n5 0 0\n6 0 0\n6 1 0\n5 1 0\n";
    let table = "cut,time,s,x,y,z\n0.5,0,0,0,0,0\n0.5,0,1,1,0,0\n0.5,0,2,1,1,0\n0.5,2,0,5,0,0\n0.5,2,1,6,0,0\n0.5,2,2,6,1,0\n0.5,2,3,5,1,0\n";
    let lines = "time,line,closed,x,y,z,angle\n,0,false,0,0,0,\n,0,false,1,0,0,90\n,0,false,1,1,0,80\n1.5,0,true,5,0,0,\n1.5,0,true,6,0,0,\n1.5,0,true,6,1,0,\n1.5,0,true,5,1,0,\n";
    for (text, format, label, last_closed) in [
        (molecular, Xyz, Some("second"), None),
        (bare, Xyz, None, None),
        (table, Csv, Some("time 2, cut 0.5"), None),
        (lines, Csv, Some("time 1.5"), Some(true)),
    ] {
        let read = |choice| CurveFile::parse(Path::new("curve"), text.as_bytes(), format, choice);
        let last = read(FrameChoice::Last).expect("the last");
        let frame = last.frame.expect("several");
        assert_eq!((frame.number, frame.n_frames), (2, 2));
        if let Some(label) = label {
            let words: Vec<&str> = label.split(", ").collect();
            assert!(
                words
                    .iter()
                    .all(|word| frame.label.as_deref().is_some_and(|own| own.contains(word))),
                "{:?}",
                frame.label
            );
        }
        assert_eq!(
            (last.components[0].vertices.len(), last.components[0].closed),
            (4, last_closed)
        );
        let first = read(FrameChoice::Number(1)).expect("the first");
        assert_eq!(first.components[0].vertices.len(), 3);
        let several = read(FrameChoice::Only).expect_err("several").to_string();
        assert!(several.contains("there are 2 frames"), "{several}");
        let none = read(FrameChoice::Number(3)).expect_err("two").to_string();
        assert!(none.contains("there is no frame 3"), "{none}");
    }
    // A time that is another in each row runs along the curve.
    let along = "time,x,y,z\n0,0,0,0\n1,1,0,0\n2,1,1,0\n";
    assert_eq!(
        parse(along, Csv).expect("a curve").components[0]
            .vertices
            .len(),
        3
    );
}

#[test]
fn far_ends_make_an_open_curve() {
    let chain = |n: i32| {
        (0..n)
            .map(|k| format!("{k} {} 0\n", k % 2))
            .collect::<String>()
    };
    assert!(!parse(chain(9), Xyz).expect("a chain").components[0].is_closed());
    let ring = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    let ring = parse(ring, Xyz).expect("a ring").components.remove(0);
    assert!(ring.is_closed() && (ring.gap_over_longest_edge() - 1.0).abs() < 1e-15);
    // A gap just within and just beyond twice the edges, at the ends of the range of numbers too.
    for (gap, closed) in [(1.99, true), (2.01, false)] {
        for unit in [1.0, 1e300, 1e-300] {
            let corner = |x: f64, y: f64| V::new(x, y, 0.0) * unit;
            let height = (1.0_f64 - (0.5 * (gap - 1.0) * 0.5 * (gap - 1.0))).sqrt();
            let x = 0.5 * (gap - 1.0);
            let vertices = vec![
                corner(0.0, 0.0),
                corner(x, height),
                corner(x + 1.0, height),
                corner(gap, 0.0),
            ];
            assert_eq!(CurveComponent::new(vertices, None).is_closed(), closed);
        }
    }
    let parsed = parse("VECT\n1 3 0\n-3\n0\n0 0 0 1 0 0 9 9 9\n", Vect).expect("read");
    assert!(parsed.components[0].is_closed());
}

#[test]
fn a_repeated_first_vertex_keeps_its_edge() {
    let text = lines(|_, [x, y, z]| format!("{x} {y} {z}")) + "-2 2 1\n";
    let found = parse(text, Xyz).expect("closed").components.remove(0);
    assert_eq!(
        (found.vertices.len(), found.closed, found.repeats_first),
        (6, Some(true), true)
    );
    let open = found.open_vertices();
    assert_eq!((open.len(), open[0]), (7, open[6]));
}

/// Each file is refused with these words.
fn assert_refused<T: AsRef<[u8]>, const N: usize>(files: [(T, CurveFormat, &str); N]) {
    for (text, format, expected) in files {
        let error = refusal(&text, format);
        assert!(
            error.starts_with("curve: ") && error.contains(expected),
            "{expected}: {error}"
        );
        assert!(error.len() < 300, "{error}");
    }
}

#[test]
fn what_does_not_add_up_is_refused_with_its_line() {
    let molecule = |n: usize| {
        format!(
            "{n}\ntitle\n{}",
            lines(|_, [x, y, z]| format!("C {x} {y} {z}"))
        )
    };
    let vect = |n: usize| format!("VECT\n1 {n} 0\n-{n}\n0\n{}", xyz_rows());
    assert_refused([
        (molecule(5), Xyz, "line 8: `C 0 2 0` is left over"),
        (
            molecule(7),
            Xyz,
            "line 1: 7 vertices are announced, 6 follow",
        ),
        (molecule(usize::MAX), Xyz, "6 follow"),
        (
            "5\n0 0 0\n".to_owned() + &xyz_rows(),
            Xyz,
            "line 8: `0 2 0` is left over",
        ),
        (
            "6\n0 0 0\n".to_owned() + &xyz_rows(),
            Xyz,
            "line 2: `0 0 0` stands where the title should",
        ),
        (
            vect(5),
            Vect,
            "line 10: `0` is left over after 5 vertices and 0 colours",
        ),
        (
            vect(7),
            Vect,
            "line 10: the file ends where a coordinate should stand",
        ),
        (
            "VECT\n9999999999 3 0\n-3\n0\n".to_owned(),
            Vect,
            "line 4: the file ends",
        ),
        (
            "VECT\n-1 0 0\n".to_owned(),
            Vect,
            "line 2: `-1` is not the number of components",
        ),
        (
            "VECT\n1 3 0\n-4\n0\n".to_owned(),
            Vect,
            "4 vertices together, line 2 announces 3",
        ),
        (
            "VECT\n1 3 1\n-3\n0\n".to_owned(),
            Vect,
            "0 colours together, line 2 announces 1",
        ),
        (
            "VECT\n1 3 0\n-3\n0\n0 0 0\n1 x".to_owned(),
            Vect,
            "line 6: `x`",
        ),
        (
            "VEC\n".to_owned(),
            Vect,
            "line 1: the first word must be VECT",
        ),
    ]);
}

#[test]
fn columns_without_one_reading_are_refused_with_their_line() {
    assert_refused([
        (
            "0 0 0 9\n1 0 0 8\n",
            Xyz,
            "line 1: 4 numbers instead of 3, and no name tells",
        ),
        (
            "C 1 0 0 0\nC 2 1 0 0\nC 3 1 1 0\n",
            Xyz,
            "line 1: 5 columns instead of 3",
        ),
        ("0 0 0\n1 1\n", Xyz, "line 2: 2 columns instead of 3: `1 1`"),
        (
            "x,y\n0,0\n",
            Csv,
            "line 1: the header must name the columns x, y and z",
        ),
        ("x,y,z,x\n0,0,0,0\n", Csv, "each once"),
        (
            "s,u,v\n0,0,0\n",
            Csv,
            "line 1: a header that names the columns x, y and z",
        ),
        ("x,y,z\n0,0\n", Csv, "line 2: 2 columns instead of 3"),
        (
            "x,y,z,closed\n0,0,0,true\n1,0,0,false\n",
            Csv,
            "line 3: `closed` changes",
        ),
    ]);
}

#[test]
fn numbers_without_one_reading_are_refused_with_their_line() {
    assert_refused([
        ("0 0 0\n0 NaN 0\n", Xyz, "line 2: y: `NaN` is not finite"),
        (
            "0 0 0\n0 1e999 0\n",
            Xyz,
            "line 2: y: `1e999` is beyond the range",
        ),
        (
            "0 0 0\n0 1e-999 0\n",
            Xyz,
            "line 2: y: `1e-999` is beyond the range",
        ),
        (
            "0,5 1,5 2,5\n1,5 1,5 2,5\n",
            Xyz,
            "line 1: `0,5` seems to have a decimal comma",
        ),
        (
            "x;y;z\n0,5;1;2\n",
            Csv,
            "line 2: x: `0,5` seems to have a decimal comma; write decimal points",
        ),
        (
            "x,y,z\n0,5,1,5,2,5\n",
            Csv,
            "line 2: 6 columns instead of 3: `0,5,1,5,2,5`; if the commas are decimal marks",
        ),
        (
            "x,y,z\n0,0,0\n1,oops,0\n",
            Csv,
            "line 3: y: `oops` is not a number",
        ),
        (
            "x,y,z\n0,0,0\n1,,0\n",
            Csv,
            "line 3: y: a coordinate is empty",
        ),
        (
            "0 0 0\n1 \u{1} 0\n",
            Xyz,
            "line 2: the control character 0x01",
        ),
    ]);
}

#[test]
fn files_without_a_curve_are_refused() {
    assert_refused([
        ("", Xyz, "the file is empty"),
        ("x,y,z\n", Csv, "no vertex"),
        ("VECT\n0 0 0\n", Vect, "no vertex"),
    ]);
    assert!(refusal(b"\x1f\x8b\x08\0", Xyz).contains("gunzip"));
    assert!(refusal(b"\x93NUMPY\x01\0", Csv).contains("numpy.savetxt"));
    assert!(refusal(b"\0\x01\x02\0", Xyz).contains("no text"));
    assert!(refusal(b"\xff\xfe1\0 ", Xyz).contains("half a character"));
    let long = format!("0 0 0\n{}\n", "x".repeat(1 << 20));
    assert!(refusal(long, Xyz).len() < 300);
    assert!(matches!(
        CurveFormat::of(Path::new("knot.obj")),
        Err(KnotError::CurveFile { .. })
    ));
}
