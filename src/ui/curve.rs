//! Numbers as a curve of bars, the newest at the right. Knows nothing of what they measure.

use super::glyphs::BARS;

/// Whether there is anything to draw.
pub fn moves(numbers: &[f64]) -> bool {
    numbers.windows(2).any(|pair| pair[0] != pair[1])
}

/// In one row, one column for each number.
pub fn sparkline(numbers: &[f64]) -> String {
    rows(numbers, 1).concat()
}

/// In several rows, the topmost first.
pub fn rows(numbers: &[f64], rows: usize) -> Vec<String> {
    let (low, high) = bounds(numbers);
    let steps = rows * BARS.len() - 1;
    // Halved, so that the distance of the largest numbers is still one.
    let height = |n: f64| match high > low {
        true => ((n / 2.0 - low / 2.0) / (high / 2.0 - low / 2.0) * steps as f64).round() as usize + 1,
        false => 1,
    };
    let glyph = |height: usize, below: usize| match height.saturating_sub(below) {
        0 => " ",
        eighths => BARS[eighths.min(BARS.len()) - 1],
    };
    let row = |row: usize| numbers.iter().map(|&n| glyph(height(n), row * BARS.len())).collect();
    (0..rows).rev().map(row).collect()
}

/// The least and the greatest.
pub fn bounds(numbers: &[f64]) -> (f64, f64) {
    let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let high = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (low, high)
}
