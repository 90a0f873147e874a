//! Checkpoints: any serialisable value, bit for bit, in a file with a checksum.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::file::{FileError, write_atomic_bytes};

const MAGIC: &[u8; 8] = b"TOPOCKPT";
const FORMAT: u32 = 1;
const DIGEST_LENGTH: usize = 32;

/// Writes `value` to `path`, atomically.
///
/// Layout: magic word, format version, length and name of `schema`, length of the payload, the payload in postcard's encoding
/// (floating-point numbers to the bit), and a BLAKE3 digest of everything before it. `schema` names the type and its version,
/// such as `rod-run/1`: change it whenever the type changes, since the payload does not describe itself.
///
/// # Errors
/// [`FileError::Unwritable`] for a value without an encoding, [`FileError::Io`] when the file cannot be written.
///
/// # Validation
/// `numbers_come_back_to_the_bit`
pub fn save_checkpoint<T: Serialize>(
    path: &Path,
    schema: &str,
    value: &T,
) -> Result<(), FileError> {
    write_atomic_bytes(path, &checkpoint_bytes(path, schema, value)?)
}

/// The bytes that [`save_checkpoint`] writes; `path` names them in messages.
///
/// # Errors
/// [`FileError::Unwritable`] for a value without an encoding.
pub fn checkpoint_bytes<T: Serialize>(
    path: &Path,
    schema: &str,
    value: &T,
) -> Result<Vec<u8>, FileError> {
    let unwritable = |what: String| FileError::Unwritable {
        path: path.to_owned(),
        what,
    };
    let schema_length = u16::try_from(schema.len())
        .map_err(|_| unwritable("the schema name is too long".to_owned()))?;
    let payload = postcard::to_stdvec(value).map_err(|e| unwritable(e.to_string()))?;
    let mut bytes = Vec::with_capacity(payload.len() + schema.len() + 64);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&FORMAT.to_le_bytes());
    bytes.extend_from_slice(&schema_length.to_le_bytes());
    bytes.extend_from_slice(schema.as_bytes());
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&payload);
    let digest = blake3::hash(&bytes);
    bytes.extend_from_slice(digest.as_bytes());
    Ok(bytes)
}

/// Reads what [`save_checkpoint`] wrote with the same `schema`.
///
/// # Errors
/// [`FileError`] when the file cannot be read, is no checkpoint, is truncated, has another format or schema, or is corrupt.
///
/// # Validation
/// `every_flaw_is_found_and_named`
pub fn load_checkpoint<T: DeserializeOwned>(path: &Path, schema: &str) -> Result<T, FileError> {
    let bytes = std::fs::read(path).map_err(|e| FileError::io("read", path, e))?;
    parse_checkpoint(path, &bytes, schema)
}

/// Reads the bytes that [`save_checkpoint`] wrote with the same `schema`; `path` names them in messages.
///
/// # Errors
/// As [`load_checkpoint`], except those of the file system.
///
/// # Validation
/// `every_flaw_is_found_and_named`
pub fn parse_checkpoint<T: DeserializeOwned>(
    path: &Path,
    bytes: &[u8],
    schema: &str,
) -> Result<T, FileError> {
    let corrupt = |what: &str| FileError::Corrupt {
        path: path.to_owned(),
        what: what.to_owned(),
    };
    let mut reader = Reader { rest: bytes, path };
    let magic = reader.take(MAGIC.len().min(bytes.len()))?;
    if !MAGIC.starts_with(magic) {
        return Err(FileError::NotACheckpoint {
            path: path.to_owned(),
        });
    }
    if magic.len() < MAGIC.len() {
        return Err(FileError::Truncated {
            path: path.to_owned(),
        });
    }
    let found = u32::from_le_bytes(reader.array()?);
    if found != FORMAT {
        return Err(FileError::Version {
            path: path.to_owned(),
            found,
            expected: FORMAT,
        });
    }
    let schema_length = u16::from_le_bytes(reader.array()?);
    let found_schema = reader.take(usize::from(schema_length))?;
    let payload_length = u64::from_le_bytes(reader.array()?);
    // Later checks trust the digest only, so it comes before any meaning is read.
    let payload = reader.take(usize::try_from(payload_length).unwrap_or(usize::MAX))?;
    let digest: [u8; DIGEST_LENGTH] = reader.array()?;
    if !reader.rest.is_empty() {
        return Err(corrupt("it goes on after its end"));
    }
    if blake3::hash(&bytes[..bytes.len() - DIGEST_LENGTH]) != digest {
        return Err(corrupt("its checksum differs"));
    }
    if found_schema != schema.as_bytes() {
        let found = String::from_utf8_lossy(found_schema).into_owned();
        return Err(FileError::Schema {
            path: path.to_owned(),
            found,
            expected: schema.to_owned(),
        });
    }
    let (value, rest) = postcard::take_from_bytes(payload).map_err(|e| corrupt(&e.to_string()))?;
    if rest.is_empty() {
        Ok(value)
    } else {
        Err(corrupt("the payload is longer than its type"))
    }
}

/// Short hash of everything that a case depends on. A case accepts only checkpoints that hold its own hash.
pub fn case_identity<T: Serialize>(all: &T) -> String {
    match postcard::to_stdvec(all) {
        Ok(bytes) => blake3::hash(&bytes).to_hex()[..32].to_owned(),
        // such a case has no checkpoint either
        Err(error) => error.to_string(),
    }
}

struct Reader<'a> {
    rest: &'a [u8],
    path: &'a Path,
}

impl<'a> Reader<'a> {
    fn take(&mut self, n: usize) -> Result<&'a [u8], FileError> {
        let (head, rest) = self
            .rest
            .split_at_checked(n)
            .ok_or_else(|| FileError::Truncated {
                path: self.path.to_owned(),
            })?;
        self.rest = rest;
        Ok(head)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], FileError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Serialize, Deserialize, PartialEq, Debug)]
    struct Run {
        time: f64,
        name: String,
        positions: Vec<nalgebra::Vector3<f64>>,
        bits: Vec<f64>,
    }

    fn run() -> Run {
        Run {
            time: 0.1 + 0.2,
            name: "trefoil".to_owned(),
            positions: vec![nalgebra::Vector3::new(1.0 / 3.0, f64::MIN_POSITIVE, -1e300)],
            bits: vec![f64::NAN, -0.0, f64::INFINITY, 5e-324, f64::EPSILON],
        }
    }

    #[test]
    fn numbers_come_back_to_the_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.ckpt");
        save_checkpoint(&path, "test/1", &run()).unwrap();
        let back: Run = load_checkpoint(&path, "test/1").unwrap();
        assert_eq!(
            (back.time.to_bits(), &back.positions, &back.name),
            (run().time.to_bits(), &run().positions, &run().name)
        );
        let bits = |r: &Run| r.bits.iter().map(|b| b.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&back), bits(&run()));
    }

    #[test]
    fn every_flaw_is_found_and_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.ckpt");
        let load = || load_checkpoint::<Run>(&path, "test/1").unwrap_err();
        assert!(matches!(load(), FileError::Io { .. }));
        assert!(load().to_string().contains("run.ckpt"));
        save_checkpoint(&path, "other/3", &run()).unwrap();
        assert!(load().to_string().contains("`other/3` instead of `test/1`"));
        save_checkpoint(&path, "test/1", &(1.0, 2)).unwrap();
        assert!(matches!(load(), FileError::Corrupt { .. }));
        save_checkpoint(&path, "test/1", &run()).unwrap();
        let good = std::fs::read(&path).unwrap();
        for length in 0..good.len() {
            std::fs::write(&path, &good[..length]).unwrap();
            assert!(
                matches!(load(), FileError::Truncated { .. }),
                "{length}: {}",
                load()
            );
        }
        for at in 0..good.len() {
            let mut bad = good.clone();
            bad[at] ^= 0x40;
            std::fs::write(&path, &bad).unwrap();
            let error = load();
            let named = match at {
                0..8 => matches!(error, FileError::NotACheckpoint { .. }),
                8..12 => matches!(error, FileError::Version { .. }),
                _ => matches!(
                    error,
                    FileError::Corrupt { .. } | FileError::Truncated { .. }
                ),
            };
            assert!(named, "{at}: {error}");
        }
        std::fs::write(&path, [good.as_slice(), b"x"].concat()).unwrap();
        assert!(matches!(load(), FileError::Corrupt { .. }));
        std::fs::write(&path, b"a picture").unwrap();
        assert!(matches!(load(), FileError::NotACheckpoint { .. }));
    }

    proptest::proptest! {
        #[test]
        fn any_bytes_are_refused(bytes in proptest::collection::vec(proptest::num::u8::ANY, 0..200)) {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("noise");
            for head in [&b""[..], MAGIC, b"TOPOCKPT\x01\0\0\0"] {
                std::fs::write(&path, [head, &bytes].concat()).unwrap();
                proptest::prop_assert!(load_checkpoint::<Run>(&path, "test/1").is_err());
            }
        }
    }
}
