//! Frames as one animated PNG, which every browser plays.

use crate::error::ViewError;

/// Size of a movie in pixels.
#[derive(Debug, Clone, Copy)]
pub struct Size {
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
}

/// Encodes frames of opaque RGB bytes, shown at `rate` frames a second for ever; the last one rests for two seconds.
pub fn encode(size: Size, rate: u16, frames: &[Vec<u8>]) -> Result<Vec<u8>, ViewError> {
    let wrong = |e: png::EncodingError| ViewError::Drawing {
        reason: format!("movie: {e}"),
    };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.width, size.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    let n = u32::try_from(frames.len()).unwrap_or(u32::MAX);
    encoder.set_animated(n, 0).map_err(wrong)?;
    encoder.set_frame_delay(1, rate).map_err(wrong)?;
    let mut writer = encoder.write_header().map_err(wrong)?;
    for (k, frame) in frames.iter().enumerate() {
        if k + 1 == frames.len() {
            writer.set_frame_delay(2, 1).map_err(wrong)?;
        }
        writer.write_image_data(frame).map_err(wrong)?;
    }
    writer.finish().map_err(wrong)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_comes_back() {
        let size = Size {
            width: 8,
            height: 4,
        };
        let frames: Vec<Vec<u8>> = (0..5).map(|k| vec![40 * k; 96]).collect();
        let bytes = encode(size, 24, &frames).unwrap();
        let decoder = png::Decoder::new(std::io::Cursor::new(&bytes));
        let mut reader = decoder.read_info().unwrap();
        let n = reader.info().animation_control().unwrap().num_frames;
        assert_eq!(n, 5);
        for frame in &frames {
            let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut buffer).unwrap();
            assert_eq!(&buffer, frame);
        }
    }
}
