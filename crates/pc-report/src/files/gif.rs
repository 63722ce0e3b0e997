//! A sequence of drawings as an animated GIF.

use crate::picture::Drawing;
use gif::{Encoder, Frame, Repeat};

use crate::files::error::PictureError;
use crate::files::glyphs::Glyphs;
use crate::files::png::{opaque, painted};

/// The number of pixels per point.
const SCALE: f32 = 1.0;
/// The number of stills per second.
const RATE: f64 = 25.0;
/// The duration of a still at this rate, in hundredths of a second.
const DELAY: u16 = 4;
/// The largest number of intervals between the stills of a film: longer motions are shown faster.
const MOST: usize = 250;
/// The speed at which colours are chosen, from 1 (best) to 30; 1 takes ten times as long, and lines on white
/// look the same.
const SPEED: i32 = 10;

/// The indices of the stills that show the motion at its true speed, given the `times` of all stills.
pub fn stills(times: &[f64]) -> Vec<usize> {
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return Vec::new() };
    let span = last - first;
    let intervals = (span.abs() * RATE).round().clamp(1.0, MOST as f64) as usize;
    let time = |i: usize| first + span * i as f64 / intervals as f64;
    (0..=intervals).map(|i| nearest(times, time(i))).collect()
}

/// The index of the entry of `times` that is nearest to `time`.
pub fn nearest(times: &[f64], time: f64) -> usize {
    let distance = |&i: &usize| (times[i] - time).abs();
    (0..times.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}

/// The drawings as a film that repeats.
///
/// # Errors
/// [`PictureError`]
pub fn gif(drawings: impl Iterator<Item = Drawing>) -> Result<Vec<u8>, PictureError> {
    let encoding = |error: gif::EncodingError| PictureError::Encode { message: error.to_string() };
    let glyphs = Glyphs::new()?;
    let (mut encoder, mut before) = (None, Vec::new());
    for drawing in drawings {
        let pixels = painted(&drawing, SCALE, &glyphs)?;
        let (width, height) = (pixels.width(), pixels.height());
        let sides = u16::try_from(width).ok().zip(u16::try_from(height).ok());
        let (wide, high) = sides.ok_or(PictureError::Size { width, height })?;
        let encoder = match &mut encoder {
            Some(encoder) => encoder,
            None => {
                let mut begun = Encoder::new(Vec::new(), wide, high, &[]).map_err(encoding)?;
                begun.set_repeat(Repeat::Infinite).map_err(encoding)?;
                encoder.insert(begun)
            }
        };
        let seen = coarse(opaque(&pixels));
        let mut frame = Frame::from_rgba_speed(wide, high, &mut changed(&seen, &before), SPEED);
        before = seen;
        frame.delay = DELAY;
        encoder.write_frame(&frame).map_err(encoding)?;
    }
    match encoder {
        Some(encoder) => {
            encoder.into_inner().map_err(|error| PictureError::Encode { message: error.to_string() })
        }
        None => Ok(Vec::new()),
    }
}

/// The colours with 32 steps of red, green and blue, which are hardly seen, and compress better.
fn coarse(mut pixels: Vec<u8>) -> Vec<u8> {
    pixels.iter_mut().for_each(|part| *part = *part & 0xf8 | *part >> 5);
    pixels
}

/// The red, green, blue and opacity of each pixel: what is as in the still before lets it through.
fn changed(pixels: &[u8], before: &[u8]) -> Vec<u8> {
    let is_same = |i: usize, pixel: &[u8]| before.get(3 * i..3 * i + 3) == Some(pixel);
    let pixels = pixels.chunks_exact(3).enumerate();
    let through = |(i, pixel): (usize, &[u8])| match is_same(i, pixel) {
        true => [0; 4],
        false => [pixel[0], pixel[1], pixel[2], 255],
    };
    pixels.flat_map(through).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_change_is_not_written_again() {
        let (white, red) = ([255; 3], [200, 0, 9]);
        let before = [white, white].concat();
        assert_eq!(coarse([red, white].concat()), [206, 0, 8, 255, 255, 255]);
        assert_eq!(changed(&[red, white].concat(), &before), [200, 0, 9, 255, 0, 0, 0, 0]);
        assert_eq!(changed(&before, &[]), [255; 8]);
    }

    #[test]
    fn a_film_is_as_long_as_its_motion() {
        let times: Vec<f64> = (0..=600).map(|i| f64::from(i) / 300.0).collect();
        let shown = stills(&times);
        assert_eq!((shown.len(), shown[0], shown[25], shown[50]), (51, 0, 300, 600));
        let long: Vec<f64> = (0..=600).map(|i| -f64::from(i)).collect();
        let shown = stills(&long);
        assert_eq!((shown.len(), shown[0], shown.last()), (MOST + 1, 0, Some(&600)));
        assert_eq!(stills(&[1.0]), [0, 0]);
        assert_eq!(nearest(&times, 0.0171), 5);
    }
}
