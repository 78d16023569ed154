//! Sensor noise that depends only on the seed, the moment and the sensor, never on how often a sensor is read.

use std::f64::consts::TAU;

/// How much the sensors' readings scatter: standard deviations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Of the light sensor, in its units (0 to 255).
    pub light: f64,
    /// Of the range sensor, m.
    pub range: f64,
}

impl Noise {
    /// Perfect sensors.
    pub const NONE: Noise = Noise { light: 0.0, range: 0.0 };

    /// The same noise without what makes no sense: negative, not a number, larger than any reading.
    pub(crate) fn sensible(self) -> Noise {
        let within = |value: f64, most: f64| {
            if value.is_nan() { 0.0 } else { value.clamp(0.0, most) }
        };
        Noise { light: within(self.light, 255.0), range: within(self.range, crate::robot::MAX_RANGE) }
    }
}

/// Which sensor a deviation is for: each scatters by itself.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Channel {
    Light = 1,
    Range = 2,
}

/// A number from the standard normal distribution, the same for the same arguments.
pub(crate) fn deviation(seed: u64, tick: u64, channel: Channel) -> f64 {
    let first = scrambled(scrambled(seed) ^ scrambled(tick.wrapping_mul(4).wrapping_add(channel as u64)));
    let second = scrambled(first);
    // Box-Muller; 1 - u keeps the logarithm away from zero.
    (-2.0 * (1.0 - unit(first)).ln()).sqrt() * (TAU * unit(second)).cos()
}

/// A number from 0 up to, not including, 1.
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

/// One round of the splitmix64 generator.
fn scrambled(state: u64) -> u64 {
    let mut bits = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}
