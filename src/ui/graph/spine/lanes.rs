//! Gives each of the lines on one side of a column of boxes a lane of its own. Knows nothing of what the lines join.

/// A line's upright run.
#[derive(Clone, Copy, Debug)]
pub struct Track {
    /// How many lanes beside the boxes it leaves to others.
    spared: usize,
    /// Its first and last row, both included.
    pub top: usize,
    pub bottom: usize,
    /// The boxes, from the top, at which it begins and ends.
    boxes: (usize, usize),
}

impl Track {
    /// Between two rows, each with the box that it belongs to.
    pub fn between(a: (usize, usize), b: (usize, usize)) -> Track {
        let ((top, first), (bottom, last)) = (a.min(b), a.max(b));
        Track { spared: 0, top, bottom, boxes: (first, last) }
    }

    /// Leaves so many lanes beside the boxes to lines at a box or between neighbours.
    pub fn sparing(self, lanes: usize) -> Track {
        Track { spared: lanes, ..self }
    }

    pub fn is_long(self) -> bool {
        self.boxes.1 > self.boxes.0 + 1
    }

    pub fn covers(self, row: usize) -> bool {
        self.top <= row && row <= self.bottom
    }

    /// What a track encloses comes before it. Rows that come and go change little in this order.
    fn order(self) -> (usize, usize, usize) {
        let (first, last) = self.boxes;
        (last - first, first, self.bottom - self.top)
    }
}

/// The lane of each track, as a distance from the boxes in columns. `reach` says for each row how far from the boxes
/// other things stand there.
///
/// Short tracks choose first, so whatever one track encloses lies inside it, and two tracks cross at most once.
pub fn assign(tracks: &[Track], reach: &[usize]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..tracks.len()).collect();
    order.sort_by_key(|&i| (tracks[i].order(), i));
    let mut taken: Vec<Vec<Track>> = Vec::new();
    let mut lanes = vec![0; tracks.len()];
    for i in order {
        let track = tracks[i];
        let mut lane = 1 + track.spared + reach[track.top..=track.bottom].iter().max().copied().unwrap_or(0);
        while taken
            .get(lane)
            .is_some_and(|others| others.iter().any(|o| o.top <= track.bottom && track.top <= o.bottom))
        {
            lane += 1;
        }
        if taken.len() <= lane {
            taken.resize(lane + 1, Vec::new());
        }
        taken[lane].push(track);
        lanes[i] = lane;
    }
    lanes
}
