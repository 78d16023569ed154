//! When a save counts as whole, in virtual time: no clock, no disk.

use std::sync::Arc;
use std::time::Duration;

use lrp::session::loader::Unreadable;
use lrp::session::watch::settling::{BUSY, COARSE, News, PATIENCE, SETTLE, Settling, Stir};
use lrp::session::watch::stamp::Stamp;

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

fn text(text: &str) -> Arc<str> {
    text.into()
}

fn stamp(size: u64) -> Option<Stamp> {
    Some(Stamp { size, ..Stamp::default() })
}

fn missing() -> Result<Arc<str>, Unreadable> {
    Err(Unreadable::Missing { path: "a.lrp".into(), nearest: None })
}

fn empty() -> Result<Arc<str>, Unreadable> {
    Err(Unreadable::Empty { path: "a.lrp".into() })
}

fn forbidden() -> Unreadable {
    Unreadable::Forbidden { path: "a.lrp".into() }
}

/// A file with the text "old", read and still, at time 0.
fn file() -> Settling {
    let mut file = Settling::new(Some(text("old")), ms(0));
    assert_eq!(file.found(Ok(text("old")), ms(0)), None);
    assert_eq!(file.due(), None);
    file
}

#[test]
fn a_save_is_read_once_it_has_been_still() {
    let mut file = file();
    file.stir(Stir::Whole, ms(100));
    file.stir(Stir::Whole, ms(110));
    assert_eq!(file.due(), Some(ms(110) + SETTLE));
    assert!(!file.is_due(ms(129)) && file.is_due(ms(130)));
    assert_eq!(file.found(Ok(text("new")), ms(130)), Some(News::Text(text("new"))));
    assert_eq!(file.due(), None);
}

#[test]
fn the_same_text_is_no_news() {
    let mut file = file();
    file.stir(Stir::Whole, ms(100));
    assert_eq!(file.found(Ok(text("old")), ms(120)), None);
}

#[test]
fn a_file_that_grows_is_read_after_its_writer_closed_it() {
    let mut file = file();
    for n in 0..10 {
        file.stir(Stir::Written, ms(100 * n));
        file.look(stamp(n), ms(100 * n + 50));
        assert!(!file.is_due(ms(100 * n + 99)));
    }
    file.stir(Stir::Whole, ms(1000));
    assert_eq!(file.due(), Some(ms(1000) + SETTLE));
}

#[test]
fn saves_that_never_pause_are_read_all_the_same() {
    let mut file = file();
    for n in 10..16 {
        file.stir(Stir::Whole, ms(10 * n));
        assert_eq!(file.due(), Some(ms(10 * n) + SETTLE));
    }
    file.stir(Stir::Written, ms(100) + BUSY);
    assert_eq!(file.due(), Some(ms(100) + BUSY + PATIENCE), "this one isn't whole");
    file.stir(Stir::Whole, ms(102) + BUSY);
    assert!(file.is_due(ms(102) + BUSY));
    file.look(stamp(1), ms(102) + BUSY);
    assert!(!file.is_due(ms(102) + BUSY), "the next one came while it was read");
}

#[test]
fn a_writer_that_never_closes_is_waited_for_in_vain_only_so_long() {
    let mut file = file();
    file.stir(Stir::Written, ms(100));
    assert_eq!(file.due(), Some(ms(100) + PATIENCE));
    assert_eq!(file.found(Ok(text("new")), ms(1100)), Some(News::Text(text("new"))));
    file.stir(Stir::Touched, ms(2000));
    assert_eq!(file.due(), Some(ms(2000) + SETTLE));
}

#[test]
fn a_change_nobody_told_of_is_noticed_by_its_looks() {
    let mut file = file();
    file.look(stamp(3), ms(0));
    assert_eq!(file.found(Ok(text("old")), ms(20)), None);
    file.poll(stamp(3), COARSE);
    assert_eq!(file.due(), None, "nothing changed");
    file.poll(stamp(4), COARSE + ms(250));
    assert_eq!(file.due(), Some(COARSE + ms(250) + SETTLE));
}

#[test]
fn for_a_while_after_a_change_looks_are_not_trusted() {
    let mut file = file();
    file.look(stamp(3), ms(100));
    assert_eq!(file.found(Ok(text("old")), ms(120)), None);
    file.poll(stamp(3), ms(250));
    assert!(file.is_due(ms(250)), "the same size and time may hide another text");
    assert_eq!(file.found(Ok(text("new")), ms(250)), Some(News::Text(text("new"))));
}

#[test]
fn a_file_that_is_gone_for_a_moment_was_only_being_saved() {
    let mut file = file();
    file.stir(Stir::Touched, ms(100));
    assert_eq!(file.found(missing(), ms(120)), None);
    assert_eq!(file.due(), Some(ms(120) + PATIENCE));
    file.stir(Stir::Whole, ms(500));
    assert_eq!(file.found(Ok(text("old")), ms(520)), None);
    assert_eq!(file.due(), None);
}

#[test]
fn a_file_that_stays_away_is_missed_once_and_welcomed_back() {
    let mut file = file();
    file.stir(Stir::Touched, ms(100));
    assert_eq!(file.found(missing(), ms(120)), None);
    assert_eq!(file.found(missing(), ms(1120)), Some(News::Missing));
    assert_eq!(file.due(), None);
    file.stir(Stir::Touched, ms(2000));
    assert_eq!(file.found(missing(), ms(2020)), None);
    assert_eq!(file.found(missing(), ms(3020)), None, "this is known");
    assert_eq!(file.found(Ok(text("old")), ms(4000)), Some(News::Back));
    assert_eq!(file.found(Ok(text("old")), ms(4500)), None);
}

#[test]
fn one_that_comes_back_changed_is_read_as_changed() {
    let mut file = file();
    assert_eq!(file.found(empty(), ms(100)), None);
    let Err(why) = empty() else { unreachable!() };
    assert_eq!(file.found(empty(), ms(1100)), Some(News::Unreadable(why)));
    assert_eq!(file.found(Ok(text("new")), ms(2000)), Some(News::Text(text("new"))));
}

#[test]
fn other_trouble_is_told_at_once_and_once() {
    let mut file = file();
    assert_eq!(file.found(Err(forbidden()), ms(100)), Some(News::Unreadable(forbidden())));
    assert_eq!(file.found(Err(forbidden()), ms(200)), None);
    assert_eq!(file.found(Ok(text("old")), ms(300)), Some(News::Back));
}

#[test]
fn a_slow_writer_is_not_disturbed_by_the_wait_for_an_empty_file() {
    let mut file = file();
    file.stir(Stir::Whole, ms(0));
    assert_eq!(file.found(empty(), ms(20)), None);
    file.stir(Stir::Written, ms(900));
    assert!(!file.is_due(ms(1100)), "half a text would be read");
}

#[test]
fn of_a_file_without_a_text_only_a_text_is_news() {
    let mut file = Settling::new(None, ms(0));
    assert_eq!(file.due(), Some(SETTLE));
    assert_eq!(file.found(missing(), ms(20)), None);
    assert_eq!(file.found(missing(), ms(1020)), None);
    assert_eq!(file.found(Ok(text("new")), ms(2000)), Some(News::Text(text("new"))));
}

#[test]
fn what_the_caller_took_is_known_from_then_on() {
    let mut file = file().knowing(Some(text("half")));
    assert!(file.is_due(SETTLE));
    assert_eq!(file.found(Ok(text("old")), ms(100)), Some(News::Text(text("old"))));
    let file = file.knowing(Some(text("old")));
    assert_eq!(file.due(), None, "this is known");
    let mut file = file.knowing(None);
    assert_eq!(file.found(missing(), ms(200)), None);
    assert_eq!(file.found(missing(), ms(1200)), None, "and so is its absence");
    let mut file = file.knowing(Some(text("new")));
    assert_eq!(file.found(Ok(text("new")), ms(1300)), None);
}

#[test]
fn one_that_was_missed_is_welcomed_back_also_with_a_text_taken_meanwhile() {
    let mut file = file();
    assert_eq!(file.found(missing(), ms(100)), None);
    assert_eq!(file.found(missing(), ms(1100)), Some(News::Missing));
    let mut file = file.knowing(Some(text("half")));
    assert_eq!(file.found(Ok(text("half")), ms(1200)), Some(News::Back));
    assert_eq!(file.found(Ok(text("old")), ms(1300)), Some(News::Text(text("old"))));
}
