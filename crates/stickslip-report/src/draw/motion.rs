//! Pictures one after the other in one file: animated PNG, of 16 million colours, and GIF, of 256 a picture.

use std::path::Path;

use super::png::Png;

/// Kinds of files of pictures in motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Animated PNG.
    Png,
    /// GIF.
    Gif,
}

impl Format {
    /// By the ending of the name of a file.
    pub fn of(file: &Path) -> Option<Format> {
        let ending = file.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "png" | "apng" => Some(Format::Png),
            "gif" => Some(Format::Gif),
            _ => None,
        }
    }
}

/// A file of pictures that are shown one after the other without end.
pub struct Motion {
    size: [u32; 2],
    /// How long each is shown, in hundredths of a second.
    delay: u16,
    /// The picture before, red, green, blue of each of its pixels.
    before: Vec<u8>,
    encoder: Encoder,
}

enum Encoder {
    /// The file is made at the end: its header has the number of pictures.
    Png(Vec<Part>),
    Gif(Box<gif::Encoder<Vec<u8>>>),
}

/// The rectangle of a picture that differs from the one before.
struct Part {
    at: [u32; 2],
    size: [u32; 2],
    /// Red, green, blue.
    pixels: Vec<u8>,
}

impl Motion {
    /// An empty file of so many pictures a second.
    pub fn new(format: Format, size: [u32; 2], rate: f64) -> Motion {
        let encoder = match format {
            Format::Png => Encoder::Png(Vec::new()),
            Format::Gif => {
                let [width, height] = size.map(|n| n as u16);
                let encoder = gif::Encoder::new(Vec::new(), width, height, &[]);
                let mut encoder = encoder.expect(MEMORY);
                encoder.set_repeat(gif::Repeat::Infinite).expect(MEMORY);
                Encoder::Gif(Box::new(encoder))
            }
        };
        Motion {
            size,
            delay: (100.0 / rate).round().clamp(1.0, 6000.0) as u16,
            before: Vec::new(),
            encoder,
        }
    }

    /// Adds a picture, of the size of the file.
    pub fn push(&mut self, picture: &Png) {
        let pixels = picture.pixels();
        let part = changed(&self.before, &pixels, self.size);
        self.before = pixels;
        match &mut self.encoder {
            Encoder::Png(parts) => parts.push(part),
            Encoder::Gif(encoder) => {
                let [width, height] = part.size.map(|n| n as u16);
                // Colours are chosen from a tenth of the pixels, as its authors advise.
                let mut frame = gif::Frame::from_rgb_speed(width, height, &part.pixels, 10);
                [frame.left, frame.top] = part.at.map(|n| n as u16);
                frame.delay = self.delay;
                frame.dispose = gif::DisposalMethod::Keep;
                encoder.write_frame(&frame).expect(MEMORY);
            }
        }
    }

    /// The file.
    pub fn finish(self) -> Vec<u8> {
        match self.encoder {
            Encoder::Gif(encoder) => encoder.into_inner().expect(MEMORY),
            Encoder::Png(parts) => animated(&parts, self.size, self.delay),
        }
    }
}

/// Why writing cannot fail.
const MEMORY: &str = "writing to memory does not fail";

/// What differs from the picture before: all of the first.
fn changed(before: &[u8], now: &[u8], [width, height]: [u32; 2]) -> Part {
    let row = 3 * width as usize;
    let all = [[0, 0], [width as usize, height as usize]];
    let mut bounds = match before.len() == now.len() {
        true => [[usize::MAX; 2], [0; 2]],
        false => all,
    };
    if before.len() == now.len() {
        let pixels = before.chunks_exact(3).zip(now.chunks_exact(3)).enumerate();
        for (i, _) in pixels.filter(|(_, (a, b))| a != b) {
            let at = [i % width as usize, i / width as usize];
            for c in 0..2 {
                bounds[0][c] = bounds[0][c].min(at[c]);
                bounds[1][c] = bounds[1][c].max(at[c] + 1);
            }
        }
    }
    if bounds[1] == [0; 2] {
        // Nothing moved: a picture has to have a pixel.
        bounds = [[0, 0], [1, 1]];
    }
    let [[left, top], [right, bottom]] = bounds;
    let rows = (top..bottom).map(|y| &now[y * row + 3 * left..y * row + 3 * right]);
    Part {
        at: [left as u32, top as u32],
        size: [(right - left) as u32, (bottom - top) as u32],
        pixels: rows.flatten().copied().collect(),
    }
}

fn animated(parts: &[Part], [width, height]: [u32; 2], delay: u16) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder
        .set_animated(parts.len() as u32, 0)
        .expect("there is a picture");
    encoder.set_frame_delay(delay, 100).expect(MEMORY);
    let mut writer = encoder.write_header().expect(MEMORY);
    for part in parts {
        let [width, height] = part.size;
        let [left, top] = part.at;
        // The place first goes to the corner, so that the size fits.
        writer.reset_frame_position().expect(MEMORY);
        writer.set_frame_dimension(width, height).expect(MEMORY);
        writer.set_frame_position(left, top).expect(MEMORY);
        writer.write_image_data(&part.pixels).expect(MEMORY);
    }
    writer.finish().expect(MEMORY);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Canvas;

    /// A square that moves to the right over four pictures.
    fn film(format: Format) -> Vec<u8> {
        let size = [40, 20];
        let mut motion = Motion::new(format, size, 20.0);
        for k in 0..4 {
            let mut picture = Png::new(size).expect("a picture");
            picture.rectangle([2.0 + 8.0 * f64::from(k), 5.0], [6.0, 6.0], [200, 0, 0]);
            motion.push(&picture);
        }
        motion.finish()
    }

    /// Where the square is in a picture: the first red pixel of row 8.
    fn square(pixels: &[u8], channels: usize) -> Option<usize> {
        let row = &pixels[8 * 40 * channels..9 * 40 * channels];
        let mut pixels = row.chunks_exact(channels);
        pixels.position(|p| p[0] > 150 && p[1] < 80)
    }

    #[test]
    fn an_animated_png_has_all_pictures_and_others_see_the_first() {
        let file = film(Format::Png);
        let decoder = png::Decoder::new(std::io::Cursor::new(&file));
        let mut reader = decoder.read_info().expect("a PNG file");
        let control = *reader.info().animation_control().expect("animated");
        assert_eq!((control.num_frames, control.num_plays), (4, 0));
        let mut whole = vec![255; 40 * 20 * 3];
        for k in 0..4 {
            let mut part = vec![0; 40 * 20 * 3];
            let info = reader.next_frame(&mut part).expect("a picture");
            let frame = *reader.info().frame_control().expect("its place");
            assert_eq!((frame.delay_num, frame.delay_den), (5, 100));
            let width = 3 * info.width as usize;
            for y in 0..info.height as usize {
                let to = 3 * (40 * (y + frame.y_offset as usize) + frame.x_offset as usize);
                whole[to..to + width].copy_from_slice(&part[y * width..(y + 1) * width]);
            }
            assert_eq!(square(&whole, 3), Some(2 + 8 * k));
        }
    }

    #[test]
    fn a_gif_has_all_pictures() {
        let file = film(Format::Gif);
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut reader = options.read_info(file.as_slice()).expect("a GIF file");
        let mut whole = vec![255; 40 * 20 * 4];
        let mut count = 0;
        while let Some(frame) = reader.read_next_frame().expect("a picture") {
            assert_eq!(frame.delay, 5);
            let width = 4 * usize::from(frame.width);
            for y in 0..usize::from(frame.height) {
                let to = 4 * (40 * (y + usize::from(frame.top)) + usize::from(frame.left));
                whole[to..to + width].copy_from_slice(&frame.buffer[y * width..(y + 1) * width]);
            }
            assert_eq!(square(&whole, 4), Some(2 + 8 * count));
            count += 1;
        }
        assert_eq!(count, 4);
    }
}
