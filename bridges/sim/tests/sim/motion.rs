//! How the robot moves: limits, dead-man, walls, and that the way time is divided makes no difference.

use std::f64::consts::{FRAC_PI_4, PI};

use lrp_sim::{Noise, Point, Sim, Twist, World, robot};
use proptest::prelude::*;

fn sim(text: &str) -> Sim {
    Sim::new(World::parse(text).unwrap(), Noise::NONE, 0)
}

fn open_floor() -> Sim {
    sim("size 20 20\nstart 10 10 heading 0")
}

/// A floor with corners, wedges, a gap too narrow and one just wide enough.
const CROWDED: &str = "size 2 1.5\nstart 0.3 0.3 heading 45\nbox 0.8 0.4 0.3 0.3\nwall 1.3 0 1.6 0.6\nwall 1.6 0.6 1.9 0\n\
    wall 0.4 0.9 1.2 1.2\nwall 0.4 1.1 1.2 1.22\nlight 0.08";

fn drive(sim: &mut Sim, linear: f64, angular: f64, seconds: f64) {
    let end = sim.now_us() + (seconds * 1e6) as u64;
    while sim.now_us() < end {
        sim.drive(Twist { linear, angular }).unwrap();
        sim.advance_to(end.min(sim.now_us() + 100_000));
    }
}

fn clearance(sim: &Sim) -> f64 {
    let pose = sim.pose();
    sim.world().clearance(Point { x: pose.x, y: pose.y })
}

#[test]
fn it_drives_as_told_after_speeding_up() {
    let mut sim = open_floor();
    drive(&mut sim, 0.3, 0.0, 2.0);
    // 0.1 s at the average of 0 and 0.3 m/s, then 1.9 s at 0.3 m/s.
    assert!((sim.pose().x - 10.585).abs() < 0.001, "{:?}", sim.pose());
    assert_eq!((sim.pose().y, sim.pose().theta), (10.0, 0.0));
}

#[test]
fn turning_left_is_positive_and_angles_wrap() {
    let mut sim = open_floor();
    drive(&mut sim, 0.0, 1.0, 1.0);
    assert!((sim.pose().theta - 0.975).abs() < 0.001);
    drive(&mut sim, 0.0, 1.0, 3.0);
    assert!((sim.pose().theta - (3.975 - 2.0 * PI)).abs() < 0.001);
}

#[test]
fn driving_while_turning_makes_a_circle() {
    let mut sim = open_floor();
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    for _ in 0..200 {
        drive(&mut sim, 0.4, 1.0, 0.05);
        low = low.min(sim.pose().y);
        high = high.max(sim.pose().y);
    }
    assert!((high - low - 0.8).abs() < 0.01, "{}", high - low);
}

#[test]
fn the_dead_man_stops_it_half_a_second_after_the_last_command() {
    let mut sim = open_floor();
    sim.drive(Twist { linear: 0.3, angular: 1.0 }).unwrap();
    sim.advance_to(500_000);
    let lapsed = sim.pose();
    sim.advance_to(620_000);
    let braked = sim.pose();
    assert!(braked.x > lapsed.x && braked.x < lapsed.x + 0.016);
    sim.advance_to(u64::MAX);
    assert_eq!(sim.pose(), braked);
}

#[test]
fn halting_brakes_at_once() {
    let mut sim = open_floor();
    drive(&mut sim, 0.3, 0.0, 1.0);
    let before = sim.pose().x;
    sim.halt();
    sim.advance_to(3_000_000);
    assert!((sim.pose().x - before - 0.015).abs() < 0.001);
}

#[test]
fn too_fast_is_brought_to_the_limits_and_no_number_is_refused() {
    let mut sim = open_floor();
    drive(&mut sim, 1e300, -1e300, 1.0);
    let (x, theta) = (sim.pose().x, sim.pose().theta);
    assert!(x.is_finite() && theta.is_finite());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(sim.drive(Twist { linear: bad, angular: 0.0 }).is_err());
        let refused = sim.drive(Twist { linear: 0.0, angular: bad }).unwrap_err();
        assert!(refused.to_string().contains("finite"), "{refused}");
    }
    let mut straight = open_floor();
    drive(&mut straight, 1e300, 0.0, 1.2);
    assert!((straight.pose().x - 10.66).abs() < 0.001, "{:?}", straight.pose());
}

#[test]
fn a_wall_stops_it_and_it_can_turn_and_back_off() {
    let mut sim = sim("size 2 1\nstart 1.5 0.5 heading 0");
    drive(&mut sim, 0.5, 0.0, 3.0);
    assert!((sim.pose().x - (2.0 - robot::RADIUS)).abs() < 0.001);
    assert!(sim.bumper());
    drive(&mut sim, 0.0, 1.0, 1.0);
    assert!(sim.pose().theta > 0.9);
    drive(&mut sim, 0.0, -1.0, 1.05);
    drive(&mut sim, -0.2, 0.0, 1.0);
    assert!(sim.pose().x < 1.78 && !sim.bumper());
}

#[test]
fn along_a_wall_it_slides_no_faster_than_its_wheels_push_it_there() {
    let mut sim = sim("size 4 1\nstart 0.5 0.9 heading 45");
    drive(&mut sim, 0.3, 0.0, 1.0);
    let before = sim.pose();
    drive(&mut sim, 0.3, 0.0, 1.0);
    let slid = sim.pose().x - before.x;
    assert!((slid - 0.3 * FRAC_PI_4.cos()).abs() < 0.001, "{slid}");
    assert!((sim.pose().y - (1.0 - robot::RADIUS)).abs() < 0.001);
}

#[test]
fn a_clock_that_begins_anew_leaves_it_where_it_is() {
    let mut sim = open_floor();
    drive(&mut sim, 0.3, 0.0, 2.0);
    sim.halt();
    sim.advance_to(3_000_000);
    let pose = sim.pose();
    sim.advance_to(0);
    assert_eq!(sim.pose(), pose);
    drive(&mut sim, 0.3, 0.0, 1.0);
    assert!(sim.pose().x > pose.x + 0.25);
}

#[test]
fn a_new_world_moves_the_robot_only_where_it_must() {
    let text = "size 4 1\nstart 0.5 0.5 heading 0\n";
    let mut sim = sim(text);
    drive(&mut sim, 0.3, 0.0, 2.0);
    let pose = sim.pose();
    sim.replace_world(World::parse(&format!("{text}line\nfrom 0 0\nto 1 1\n")).unwrap());
    assert_eq!(sim.pose(), pose);
    sim.replace_world(World::parse(&format!("{text}box 0.8 0.2 1 0.6\n")).unwrap());
    assert_eq!(sim.pose(), sim.world().start());
    drive(&mut sim, 0.3, 0.0, 5.0);
    let pressing = sim.pose();
    sim.replace_world(World::parse(&format!("{text}box 0.8 0.2 1 0.6\nground 200")).unwrap());
    assert_eq!(sim.pose(), pressing);
    sim.replace_world(World::parse("size 4 1\nstart 0.6 0.5 heading 0").unwrap());
    assert_eq!(sim.pose(), sim.world().start());
}

#[test]
fn put_at_start_it_rests_there() {
    let mut sim = open_floor();
    drive(&mut sim, 0.5, 2.0, 1.0);
    sim.put_at_start();
    sim.advance_to(9_000_000);
    assert_eq!(sim.pose(), sim.world().start());
}

/// A speed somewhat beyond what the robot can, or anything at all.
fn speed(most: f64) -> impl Strategy<Value = f64> {
    prop_oneof![4 => -most..most, 1 => any::<f64>()]
}

fn commands() -> impl Strategy<Value = Vec<(f64, f64, u64)>> {
    prop::collection::vec((speed(0.8), speed(5.0), 1_u64..900_000), 1..12)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn how_time_is_divided_makes_no_difference(commands in commands(), cuts in prop::collection::vec(1_u64..40_000, 1..30)) {
        let mut whole = sim(CROWDED);
        let mut cut = whole.clone();
        let mut cuts = cuts.iter().cycle();
        for (linear, angular, pause) in commands {
            let refused = whole.drive(Twist { linear, angular }).is_err();
            prop_assert_eq!(cut.drive(Twist { linear, angular }).is_err(), refused);
            let end = whole.now_us() + pause;
            whole.advance_to(end);
            while cut.now_us() < end {
                let next = cut.now_us() + cuts.next().unwrap();
                cut.advance_to(next.min(end));
            }
            prop_assert_eq!(whole.pose(), cut.pose());
        }
    }

    #[test]
    fn it_is_never_inside_a_wall_nor_nowhere(commands in commands()) {
        let mut sim = sim(CROWDED);
        for (linear, angular, pause) in commands {
            let _ = sim.drive(Twist { linear, angular });
            let end = sim.now_us() + pause;
            while sim.now_us() < end {
                let before = sim.pose();
                sim.advance_to(end.min(sim.now_us() + 5_000));
                let pose = sim.pose();
                prop_assert!(clearance(&sim) >= robot::RADIUS - 0.001);
                let moved = (pose.x - before.x).hypot(pose.y - before.y);
                prop_assert!(moved <= robot::MAX_LINEAR * 0.005 + 1e-4, "{} m in 5 ms", moved);
                prop_assert!(pose.theta.abs() <= PI && sim.range().is_finite());
                prop_assert!((0.0..=2.0).contains(&pose.x) && (0.0..=1.5).contains(&pose.y));
            }
        }
    }
}
