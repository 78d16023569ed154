//! What the sensors say: light over a line's edge, walls ahead, the bumper, and noise that a seed repeats.

use lrp_sim::{Noise, Sim, Twist, World, robot};

fn sim(text: &str) -> Sim {
    Sim::new(World::parse(text).unwrap(), Noise::NONE, 0)
}

/// The light reading with the sensor at this height beside a line 0.1 m wide along y = 1.
fn light_at(y: f64) -> u8 {
    sim(&format!("size 4 2\nstart 2 {y} heading 0\nground 200\nline width 0.1 brightness 10\nfrom 1 1\nstraight 2"))
        .light()
}

#[test]
fn light_is_bright_off_the_line_dark_on_it_and_half_over_its_edge() {
    assert_eq!((light_at(1.1), light_at(1.0)), (200, 10));
    assert_eq!((light_at(1.05), light_at(0.95)), (105, 105));
}

#[test]
fn light_changes_smoothly_over_the_edge() {
    let readings: Vec<u8> = (0..=60).map(|step| light_at(1.04 + f64::from(step) * 0.000_333)).collect();
    assert!(readings.is_sorted());
    assert!(readings.windows(2).all(|pair| pair[1] - pair[0] <= 10), "{readings:?}");
    assert_eq!((readings[0], readings[60]), (10, 200));
}

#[test]
fn a_line_thinner_than_the_spot_is_seen_in_part() {
    let reading = sim("size 4 2\nstart 2 1\nground 200\nline width 0.006 brightness 0\nfrom 1 1\nstraight 2").light();
    assert!((50..150).contains(&reading), "{reading}");
}

#[test]
fn light_is_seen_where_the_sensor_is() {
    let text = "size 4 2\nstart 2 1 heading 90\nline width 0.02\nfrom 1.95 0.5 heading 90\nstraight 1\n";
    assert_eq!(sim(text).light(), 230);
    assert_eq!(sim(&format!("{text}light ahead 0 left 0.05")).light(), 20);
}

#[test]
fn a_later_line_covers_an_earlier_one() {
    let text = "size 4 2\nstart 2 1\nline width 0.2 brightness 0\nfrom 1 1\nstraight 2\nline width 0.1 brightness 250\nfrom 1 1\nstraight 2";
    assert_eq!(sim(text).light(), 250);
}

#[test]
fn range_is_the_way_to_the_nearest_wall_ahead() {
    let far = sim("size 3 2\nstart 1 1 heading 0");
    assert!((far.range() - (2.0 - robot::RANGE_AHEAD)).abs() < 1e-9);
    let near = sim("size 3 2\nstart 1 1 heading 0\nwall 2 0.5 1.5 1.5\nbox 2.4 0.9 0.2 0.2");
    assert!((near.range() - (0.75 - robot::RANGE_AHEAD)).abs() < 1e-9);
    assert_eq!(sim("size 20 2\nstart 1 1 heading 0").range(), robot::MAX_RANGE);
}

#[test]
fn pressed_to_a_wall_it_ranges_zero_and_the_bumper_is_in() {
    let mut sim = sim("size 3 2\nstart 2.5 1 heading 0");
    assert!(!sim.bumper());
    for step in 0..30 {
        sim.advance_to(step * 100_000);
        sim.drive(Twist { linear: 0.3, angular: 0.0 }).unwrap();
    }
    assert!(sim.bumper() && sim.range() < 0.001);
}

#[test]
fn a_wall_at_the_side_is_not_felt() {
    let at = |heading: i32| sim(&format!("size 3 2\nstart 2.9095 1 heading {heading}")).bumper();
    assert_eq!([0, 50, -50, 70, 90, 180].map(at), [true, true, true, false, false, false]);
}

fn noisy(seed: u64) -> Vec<(u8, f64)> {
    let world = World::parse("size 6 2\nstart 1 1\nline\nfrom 0.5 1.03\nstraight 5").unwrap();
    let mut sim = Sim::new(world, Noise { light: 8.0, range: 0.02 }, seed);
    (0..200)
        .map(|step| {
            sim.advance_to(step * 20_000);
            sim.drive(Twist { linear: 0.2, angular: 0.0 }).unwrap();
            (sim.light(), sim.range())
        })
        .collect()
}

#[test]
fn the_same_seed_gives_the_same_readings_and_another_seed_others() {
    assert_eq!(noisy(7), noisy(7));
    assert_ne!(noisy(7), noisy(8));
}

#[test]
fn reading_twice_at_one_moment_gives_the_same() {
    let mut sim = sim("size 3 2\nstart 1 1");
    sim.set_noise(Noise { light: 20.0, range: 0.1 });
    sim.advance_to(123_456);
    assert_eq!((sim.light(), sim.range()), (sim.light(), sim.range()));
}

#[test]
fn noise_has_the_deviation_asked_for() {
    let mut sim = sim("size 3 2\nstart 1 1\nground 128");
    sim.set_noise(Noise { light: 10.0, range: 0.0 });
    let errors: Vec<f64> = (0..4_000)
        .map(|step| {
            sim.advance_to(step * 1_000);
            f64::from(sim.light()) - 128.0
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / 4_000.0;
    let deviation = (errors.iter().map(|error| error * error).sum::<f64>() / 4_000.0).sqrt();
    assert!(mean.abs() < 0.8 && (deviation - 10.0).abs() < 0.8, "{mean} {deviation}");
}

#[test]
fn senseless_noise_does_no_harm() {
    let mut sim = sim("size 3 2\nstart 1 1");
    let quiet = (sim.light(), sim.range());
    sim.set_noise(Noise { light: f64::NAN, range: -1.0 });
    assert_eq!((sim.light(), sim.range()), quiet);
    sim.set_noise(Noise { light: f64::INFINITY, range: f64::INFINITY });
    assert!((0.0..=robot::MAX_RANGE).contains(&sim.range()));
}
