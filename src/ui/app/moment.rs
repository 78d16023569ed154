//! How long something is news: some seconds of real time, told by the robot's status, or until the next key.

/// Status comes twice a second.
const LAST: u8 = 12;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Moment {
    beats: u8,
}

impl Moment {
    /// Half a second later; none when it is over.
    pub fn later(self) -> Option<Moment> {
        let beats = self.beats + 1;
        (beats < LAST).then_some(Moment { beats })
    }
}
