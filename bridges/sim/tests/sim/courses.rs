//! The courses under `behaviors/worlds` do what they are for: a follower that looks both ways completes them, a one-sided one doesn't.

use lrp_sim::{Noise, World};

use crate::follower::{Follower, Search};

const CURVE: &str = include_str!("../../../../behaviors/worlds/curve.world");
const BENDS: &str = include_str!("../../../../behaviors/worlds/bends.world");

const GOOD: Follower = Follower { forward: 0.2, search: 1.0, maxlook: 2, ways: Search::BothWays };
const NOISE: Noise = Noise { light: 5.0, range: 0.01 };

/// Each course with the time a follower has for it, s.
const COURSES: [(&str, &str, u64); 2] = [("curve", CURVE, 180), ("bends", BENDS, 240)];

fn world(text: &str) -> World {
    World::parse(text).unwrap()
}

/// Runs the followers; every one must finish in the time allowed. Prints how long they took.
fn all_finish(course: (&str, &str, u64), followers: impl Iterator<Item = (Follower, Noise, u64)>) {
    let (name, text, allowed) = course;
    let world = world(text);
    let (mut fastest, mut slowest) = (f64::INFINITY, 0.0_f64);
    for (follower, noise, seed) in followers {
        let run = follower.run(&world, noise, seed, allowed);
        let time = run.finished().unwrap_or_else(|| panic!("{name}: {follower:?}, seed {seed}: {run:?}"));
        fastest = fastest.min(time);
        slowest = slowest.max(time);
    }
    println!("{name}: {fastest:.1} to {slowest:.1} s of {allowed} s");
}

/// Constants a programmer may choose without thinking about them much.
fn choices() -> impl Iterator<Item = Follower> {
    [0.2, 0.25, 0.3].into_iter().flat_map(|forward| {
        [1.0, 1.2, 1.5].into_iter().flat_map(move |search| {
            [2, 3].into_iter().map(move |maxlook| Follower { forward, search, maxlook, ways: Search::BothWays })
        })
    })
}

#[test]
fn the_first_course_is_long_enough() {
    assert!(world(CURVE).line_length() >= 8.0);
}

#[test]
fn a_follower_that_looks_both_ways_completes_them() {
    for course in COURSES {
        all_finish(course, choices().map(|follower| (follower, Noise::NONE, 0)));
    }
}

#[test]
fn noisy_sensors_don_t_throw_it_off() {
    for course in COURSES {
        all_finish(course, (0..25).map(|seed| (GOOD, NOISE, seed)));
    }
}

#[test]
fn a_follower_that_looks_one_way_only_never_completes_them() {
    for (name, text, allowed) in COURSES {
        let world = world(text);
        for ways in [Search::OnlyLeft, Search::OnlyRight] {
            for follower in choices() {
                let run = Follower { ways, ..follower }.run(&world, Noise::NONE, 0, allowed);
                assert_eq!(run.finished(), None, "{name}: {follower:?} {ways:?}");
            }
        }
    }
}

#[test]
fn the_strands_of_the_hard_course_are_too_far_apart_to_be_confused() {
    let course = world(BENDS);
    let line = &course.lines()[0];
    let mut along = 0.0;
    let places: Vec<_> = line
        .segments()
        .flat_map(|piece| {
            // Points at most 1 cm apart, each with its way along the line.
            let length = (piece.to.x - piece.from.x).hypot(piece.to.y - piece.from.y);
            let count = (length / 0.01).ceil();
            let begin = along;
            along += length;
            (0..count as usize).map(move |index| {
                let share = index as f64 / count;
                let x = piece.from.x + (piece.to.x - piece.from.x) * share;
                let y = piece.from.y + (piece.to.y - piece.from.y) * share;
                (begin + share * length, x, y)
            })
        })
        .collect();
    for (index, (way, x, y)) in places.iter().enumerate() {
        for (other_way, other_x, other_y) in &places[index..] {
            // Closer along the line than a half circle of that width, it is the same strand.
            if other_way - way > 0.7 {
                let apart = (x - other_x).hypot(y - other_y);
                assert!(apart >= 0.35, "{apart} m apart at {x} {y} and {other_x} {other_y}");
            }
        }
    }
}
