//! What the screen may send in a second, by layout: a slow line carries the line follower at ten steps a second, and
//! hardly notices a program that waits.

use lrp::ui::app::App;
use ratatui::layout::Size;

use crate::frames::{frame, go_on, press, screen};
use crate::meter::{Bytes, Meter, World, behavior};
use crate::story::{Story, program};

const SIZES: [(u16, u16); 4] = [(80, 24), (120, 40), (40, 24), (80, 12)];

fn minute(text: &str, (width, height): (u16, u16), world: World) -> Bytes {
    Meter::new(text, 10.0, Size { width, height }, world, "").run(60)
}

#[test]
fn the_line_follower_takes_two_kilobytes_a_second() {
    let follower = behavior("line_follower.lrp");
    for size in SIZES {
        let bytes = minute(&follower, size, World::Unknown);
        assert!((200..2048).contains(&bytes.mean()), "{} in {size:?}", bytes.mean());
        assert!(bytes.most() < 4096, "{} in one second in {size:?}", bytes.most());
    }
}

#[test]
fn counters_move_twice_a_second_and_lists_once_where_much_happens() {
    let mut app = screen(120, 40, &Story::new());
    go_on(&mut app, 0, |story| {
        _ = story.load(&program("(machine m (state a) (state b) (eps a -> b) (eps b -> a))"), &[])
    });
    go_on(&mut app, 0, |story| _ = story.spawn("m", None).enter("m/a"));
    let taken = |app: &mut App, step: u64| {
        let (from, to) = if step.is_multiple_of(2) { ("m/b", "m/a") } else { ("m/a", "m/b") };
        go_on(app, step, |story| _ = story.take("m", from, to, None, "eps", 0));
        frame(app)
    };
    let listed = |frame: &str| frame.matches(" → ").count();
    assert_eq!(listed(&taken(&mut app, 11)), 1, "the first after a quiet is listed at once");
    let seen = taken(&mut app, 12);
    assert!(seen.contains("0:01.1") && seen.contains("step 11") && listed(&seen) == 1, "{seen}");
    assert!(seen.contains("● a"), "the active state is told at once: {seen}");
    let seen = taken(&mut app, 15);
    assert!(seen.contains("0:01.5") && seen.contains("step 15") && listed(&seen) == 1, "{seen}");
    assert_eq!(listed(&taken(&mut app, 21)), 4, "a second later all of them are");
    press(&mut app, "Down");
    taken(&mut app, 22);
    press(&mut app, "Down");
    assert!(frame(&app).contains("0:02.2") && listed(&frame(&app)) == 5, "a key has all told");
}

#[test]
fn counters_alone_take_two_hundred_bytes_a_second() {
    const WAITS: &str = "(machine m (state a) (state b) (ontime 3600000 a -> b)) (spawn m a)";
    const STANDS: &str =
        "(bridge robot sim) (machine m (state a) (state b) (on [robot.light.data > 1000] a -> b)) (spawn m a)";
    for size in SIZES {
        for program in [WAITS, STANDS] {
            let bytes = minute(program, size, World::Drawn);
            assert!((10..200).contains(&bytes.mean()), "{} in {size:?}", bytes.mean());
        }
    }
}
