//! From the bytes of a file to lines of text, whatever the encoding and the ends of lines.

use std::borrow::Cow;
use std::path::Path;

use super::fault::{fault, fault_at};
use crate::KnotError;

/// First bytes of files that hold no text, what they are and the remedy.
const PACKED: [(&[u8], &str); 6] = [
    (b"\x1f\x8b", "a gzip file; unpack it first (gunzip)"),
    (b"PK\x03\x04", "a zip file; unpack it first"),
    (
        b"\x93NUMPY",
        "a numpy file; write text with numpy.savetxt(\"curve.csv\", x, delimiter=\",\", header=\"x,y,z\", comments=\"\")",
    ),
    (b"\x89HDF", "an HDF5 file; export the coordinates as text"),
    (
        b"\xff\xfe\0\0",
        "UTF-32 text; save it as UTF-8 (iconv -f UTF-32 -t UTF-8)",
    ),
    (
        b"\0\0\xfe\xff",
        "UTF-32 text; save it as UTF-8 (iconv -f UTF-32 -t UTF-8)",
    ),
];

/// The text of a file, and how it was read if not as UTF-8.
///
/// UTF-8 with or without byte-order mark, UTF-16 of either byte order and Latin-1 are read without loss; what holds control
/// characters is no text and refused.
pub(super) fn decode<'a>(
    path: &Path,
    bytes: &'a [u8],
) -> Result<(Cow<'a, str>, Option<String>), KnotError> {
    if let Some((_, what)) = PACKED.iter().find(|(head, _)| bytes.starts_with(head)) {
        return Err(fault(path, format!("this is {what}")));
    }
    let (mut text, note) = match bytes {
        [0xff, 0xfe, rest @ ..] => utf16(path, rest, u16::from_le_bytes)?,
        [0xfe, 0xff, rest @ ..] => utf16(path, rest, u16::from_be_bytes)?,
        _ if !bytes.contains(&0) => utf8_or_latin1(bytes),
        _ => match null_bytes(bytes) {
            [0, _] => utf16(path, bytes, u16::from_le_bytes)?,
            [_, 0] => utf16(path, bytes, u16::from_be_bytes)?,
            _ => {
                let problem =
                    "NUL bytes stand in it, so that this is no text file; give coordinates as text";
                return Err(fault(path, problem));
            }
        },
    };
    while let Some(rest) = text.strip_prefix('\u{feff}') {
        text = match text {
            Cow::Borrowed(text) => Cow::Borrowed(&text['\u{feff}'.len_utf8()..]),
            Cow::Owned(_) => Cow::Owned(rest.to_owned()),
        };
    }
    if let Some((line, c)) = first_control(&text) {
        let code = u32::from(c);
        return Err(fault_at(
            path,
            line,
            &format!(
                "the control character {code:#04x} stands here, so that this is no text file; give coordinates as text"
            ),
        ));
    }
    Ok((text, note))
}

/// The first control character that no text has, with its line.
fn first_control(text: &str) -> Option<(usize, char)> {
    // The first look is at bytes, since files are long: 0xc2 leads the control characters beyond ASCII, among others.
    let suspect = |byte: u8| byte < 9 || (14..32).contains(&byte) || byte == 0x7f || byte == 0xc2;
    if !text.bytes().any(suspect) {
        return None;
    }
    // Editors of old end a text with Ctrl-Z.
    let is_odd = |c: &char| c.is_control() && !"\t\n\r\u{b}\u{c}\u{1a}".contains(*c);
    lines(text).find_map(|(line, row)| Some((line, row.chars().find(is_odd)?)))
}

/// Numbers of NUL bytes at even and at odd places: text has none, UTF-16 one for each digit.
fn null_bytes(bytes: &[u8]) -> [usize; 2] {
    let mut n = [0; 2];
    for (k, _) in bytes.iter().enumerate().filter(|(_, byte)| **byte == 0) {
        n[k % 2] += 1;
    }
    n
}

fn utf8_or_latin1(bytes: &[u8]) -> (Cow<'_, str>, Option<String>) {
    match std::str::from_utf8(bytes) {
        Ok(text) => (Cow::Borrowed(text), None),
        Err(e) => {
            let (sound, rest) = bytes.split_at(e.valid_up_to());
            // The part before the error is text, so that its lines can be counted.
            let line = lines(&String::from_utf8_lossy(sound)).count().max(1);
            let byte = rest.first().copied().unwrap_or_default();
            let note = format!(
                "line {line}: the byte {byte:#04x} is not UTF-8; the file was read as Latin-1 (numbers are the same in both)"
            );
            (
                bytes.iter().map(|byte| char::from(*byte)).collect(),
                Some(note),
            )
        }
    }
}

fn utf16<'a>(
    path: &Path,
    bytes: &[u8],
    unit: fn([u8; 2]) -> u16,
) -> Result<(Cow<'a, str>, Option<String>), KnotError> {
    let remedy = "save it as UTF-8 (iconv -f UTF-16 -t UTF-8)";
    let (pairs, rest) = bytes.as_chunks::<2>();
    if !rest.is_empty() {
        let problem = format!(
            "this seems to be UTF-16 text or no text at all: it has NUL bytes or the mark of UTF-16, and half a character at its end; {remedy}"
        );
        return Err(fault(path, problem));
    }
    let text: Result<String, _> =
        char::decode_utf16(pairs.iter().map(|pair| unit(*pair))).collect();
    match text {
        Ok(text) => Ok((
            Cow::Owned(text),
            Some("the file was read as UTF-16".to_owned()),
        )),
        Err(_) => Err(fault(
            path,
            format!("this is no text file, or damaged UTF-16; {remedy}"),
        )),
    }
}

/// The lines of a text with their numbers from 1; a line ends with LF, CR LF, CR CR LF or a bare CR.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut rest = text;
    let mut number = 0;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        number += 1;
        let is_end = |byte: &u8| *byte == b'\n' || *byte == b'\r';
        let end = rest
            .bytes()
            .position(|byte| is_end(&byte))
            .unwrap_or(rest.len());
        let (line, tail) = rest.split_at(end);
        rest = ["\r\r\n", "\r\n", "\n", "\r"]
            .iter()
            .find_map(|end| tail.strip_prefix(end))
            .unwrap_or("");
        Some((number, line))
    })
}
