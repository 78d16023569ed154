//! Bricks that aren't well, each with a trap that real ones have.

use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::time::{Duration, Instant};

use lrp_bridge::{Event, Order, Peer};
use lrp_bridge_ev3::command::Command;
use lrp_bridge_ev3::link::{self, Link};
use lrp_bridge_ev3::{Ev3, frame, orders};
use lrp_fake_ev3::{Brick, Mood};
use serde_json::{Value, json};

use crate::peer::{Robot, eventually};

const READ_TIMEOUT: Duration = Duration::from_millis(300);

fn frames_of(brick: &Brick) -> usize {
    brick.state().frames.len()
}

/// Nothing to hear for a while.
fn is_silent(client: &mut TcpStream) -> bool {
    client.set_read_timeout(Some(READ_TIMEOUT)).expect("a socket");
    client.read(&mut [0; 64]).is_err()
}

/// The fake has the trap, and the bridge doesn't step into it: each frame is one write.
#[test]
fn half_a_length_jams_a_brick_for_good() {
    let brick = Brick::start(0);
    let mut client = TcpStream::connect(brick.address).expect("connected");
    client.set_nodelay(true).expect("a socket");
    client.write_all(&link::unlock("")).expect("sent");
    client.read_exact(&mut [0; 16]).expect("an accept");
    let stop = frame::command(1, &orders::full_stop());
    client.write_all(&stop[..1]).expect("sent");
    eventually("it is jammed", || brick.state().jammed);
    client.write_all(&stop[1..]).expect("sent");
    client.write_all(&stop).expect("sent");
    assert!(is_silent(&mut client));
    drop(client);
    eventually("it is free", || TcpStream::connect(brick.address).is_ok());

    let mut robot = Robot::connected(json!({ "rate": 50 }));
    for speed in 0..50 {
        assert_eq!(robot.call("motorA.start", json!([speed])), Ok(Value::Null));
    }
    assert!(!robot.brick.state().jammed);
    brick.end();
}

#[test]
fn what_comes_with_the_unlock_is_eaten() {
    let brick = Brick::start(0);
    let mut client = TcpStream::connect(brick.address).expect("connected");
    let both = [link::unlock("0016533F0C1E"), frame::command(1, &orders::full_stop())].concat();
    client.write_all(&both).expect("sent");
    client.read_exact(&mut [0; 16]).expect("an accept");
    assert!(is_silent(&mut client) && frames_of(&brick) == 0);
    brick.end();
    // The bridge waits for the accept: its first command is done.
    let robot = Robot::connected(json!({}));
    assert_eq!(robot.operations()[0], "a3000f01");
}

#[test]
fn a_brick_in_use_is_told_and_taken_later() {
    let brick = Brick::start(0);
    let first = Link::open(brick.address, "").unwrap_or_else(|trouble| panic!("{trouble}"));
    let mut robot = Robot::new(brick, json!({}));
    let why = robot.lrp.until_lost();
    assert!(why.starts_with("the brick is in use by another client"), "{why}");
    drop(first);
    robot.lrp.until_up();
}

/// A blocking opcode has the brick read nothing, not even a stop. The bridge has none.
#[test]
fn a_blocking_opcode_holds_up_a_stop() {
    let brick = Brick::start(0);
    let mut link = Link::open(brick.address, "").unwrap_or_else(|trouble| panic!("{trouble}"));
    let mut wait = Command::default();
    wait.op(0xaf).numbers(&[0, 1, 50, 0, 600, 0, 1]).op(0xaa).numbers(&[0, 1]);
    let begun = Instant::now();
    assert!(link.ask(&wait).is_ok() && link.ask(&orders::full_stop()).is_ok());
    assert!(begun.elapsed() >= Duration::from_millis(500), "{:?}", begun.elapsed());
    brick.end();

    let mut robot = Robot::connected(json!({}));
    let waiting = robot.begin("motorA.runFor", json!([60_000, 50, "brake", 0]));
    eventually("it turns", || !robot.is_still());
    robot.lrp.order(Order::Stop);
    assert_eq!(robot.lrp.reply(waiting), Err("stopped".into()));
    assert!(robot.is_still());
    assert_eq!(robot.brick.state().machine.blocked, 0);
}

#[test]
fn a_silent_brick_is_given_up_after_a_second() {
    let mut robot = Robot::connected(json!({}));
    let moving = robot.begin("motorA.moveBy", json!([100_000, 50, "brake", 0]));
    eventually("it turns", || !robot.is_still());
    let begun = Instant::now();
    robot.brick.mood(Mood::Silent);
    assert_eq!(robot.lrp.reply(moving), Err("the brick doesn't answer".into()));
    assert!(begun.elapsed() < Duration::from_millis(2500), "{:?}", begun.elapsed());
    let late = robot.call("motorA.start", json!([50]));
    assert_eq!(late, Err("no brick is connected".into()), "nothing waits for a brick that isn't there");
    robot.brick.mood(Mood::Good);
    robot.lrp.until_up();
    assert!(robot.is_still(), "what went on turning is halted first");
}

#[test]
fn a_lost_connection_is_made_anew_and_the_motors_halted() {
    let mut robot = Robot::connected(json!({}));
    assert_eq!(robot.call("motorA.start", json!([50])), Ok(Value::Null));
    robot.brick.hang_up();
    assert_eq!(robot.lrp.until_lost(), "the brick closed the connection");
    assert_eq!(robot.speed(0), 50.0, "a brick doesn't care");
    robot.lrp.until_up();
    assert!(robot.is_still());
    assert_eq!(robot.call("motorA.start", json!([20])), Ok(Value::Null));
}

#[test]
fn an_open_dialog_is_told() {
    let mut robot = Robot::connected(json!({}));
    robot.brick.mood(Mood::Dialog);
    assert_eq!(robot.lrp.until_lost(), "the brick refuses commands; close the dialog on its screen");
    robot.brick.mood(Mood::Good);
    robot.lrp.until_up();
}

/// An answer to an earlier request isn't taken for that to this one.
#[test]
fn answers_are_matched_by_their_counter() {
    let brick = Brick::start(0);
    brick.mood(Mood::Chatty);
    let mut robot = Robot::new(brick, json!({}));
    robot.lrp.until_up();
    assert_eq!(robot.lrp.input("battery"), json!({ "volts": 7.4, "amperes": 0.18, "percent": 83 }));
}

#[test]
fn what_is_no_brick_is_told() {
    let mut robot = Robot::connected(json!({}));
    robot.brick.mood(Mood::Garbage);
    assert_eq!(robot.lrp.until_lost(), "what answers there doesn't speak as an EV3 brick does");

    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    let address = listener.local_addr().expect("an address");
    let server = std::thread::spawn(move || {
        let (mut client, _) = listener.accept().expect("a client");
        client.write_all(b"HTTP/1.1 400 Bad Request\r\n\r\n").expect("sent");
    });
    let mut lrp = Peer::of::<Ev3>();
    lrp.configure(json!({ "address": address.to_string() }));
    let why = lrp.until_lost();
    assert_eq!(why, format!("what answers there doesn't speak as an EV3 brick does; tried {address}"));
    server.join().expect("served");
}

#[test]
fn nobody_there_is_told() {
    let mut lrp = Peer::of::<Ev3>();
    lrp.configure(json!({ "address": "127.0.0.1:1" }));
    let why = lrp.until_lost();
    assert!(why.contains("refused") && why.ends_with("tried 127.0.0.1:1"), "{why}");
    let begun = Instant::now();
    lrp.order(Order::Stop);
    lrp.until("`stopped`", |event| (*event == Event::Stopped).then_some(()));
    assert!(begun.elapsed() < Duration::from_secs(1), "there is nobody to wait for");
}

/// A brick that is slow gets what waits in as few frames as it can, a stop before it all.
#[test]
fn a_stop_waits_for_one_answer_at_most() {
    let mut robot = Robot::connected(json!({}));
    let slow = Duration::from_millis(150);
    robot.brick.mood(Mood::Slow(slow));
    for speed in 0..200 {
        robot.begin("motorA.start", json!([1 + speed % 100]));
    }
    std::thread::sleep(slow / 2);
    let (before, begun) = (frames_of(&robot.brick), Instant::now());
    robot.stop();
    let took = begun.elapsed();
    assert!(robot.is_still());
    assert!(took < slow * 3, "{took:?}");
    let state = robot.brick.state();
    let at = state.frames[before..].iter().position(|(_, frame)| frame[5..] == [0xa3, 0, 0x0f, 1]);
    assert!(at.is_some_and(|at| at <= 1), "{at:?}");
}

/// From lrp's order to the brick; `--nocapture` shows the figures.
#[test]
fn a_stop_is_with_the_brick_at_once() {
    let mut robot = Robot::connected(json!({ "rate": 50 }));
    let mut took: Vec<Duration> = (0..50)
        .map(|_| {
            assert_eq!(robot.call("motorA.start", json!([50])), Ok(Value::Null));
            let begun = Instant::now();
            robot.stop();
            let state = robot.brick.state();
            let (came, _) = state.frames.iter().rfind(|(_, frame)| frame[5..] == [0xa3, 0, 0x0f, 1]).expect("a stop");
            came.duration_since(begun)
        })
        .collect();
    took.sort();
    println!("stop at the brick after: median {:?}, longest {:?}", took[took.len() / 2], took[took.len() - 1]);
    assert!(took[took.len() / 2] < Duration::from_millis(50), "{took:?}");
}

#[test]
fn a_stop_undoes_what_waits() {
    let mut robot = Robot::connected(json!({}));
    robot.brick.mood(Mood::Slow(Duration::from_millis(100)));
    eventually("it reads", || frames_of(&robot.brick) > 3);
    let waiting: Vec<u64> = (0..20).map(|_| robot.begin("motorA.moveTo", json!([90, 50, "brake", 0]))).collect();
    robot.lrp.order(Order::Ping { id: 1 });
    robot.lrp.until("`pong`", |event| (*event == Event::Pong { id: 1 }).then_some(()));
    robot.lrp.order(Order::Stop);
    // The last of them; those before were undone before.
    assert_eq!(robot.lrp.reply(waiting[19]), Err("stopped".into()));
    eventually("it is still", || robot.is_still());
}

#[test]
fn without_lrp_the_motors_are_halted() {
    let mut robot = Robot::connected(json!({}));
    assert_eq!(robot.call("motorA.start", json!([50])), Ok(Value::Null));
    assert_eq!(robot.lrp.close(), 0);
    assert!(robot.is_still());
}
