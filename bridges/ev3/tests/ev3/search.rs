//! Bricks found by their beacons.

use std::net::{Ipv4Addr, UdpSocket};

use lrp_bridge::{Event, Found, Peer};
use lrp_bridge_ev3::Ev3;
use lrp_fake_ev3::Brick;
use serde_json::{Value, json};

/// A UDP port that nobody listens on.
fn port() -> u16 {
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).expect("a socket");
    socket.local_addr().expect("an address").port()
}

fn listening(port: u16, mut config: Value) -> Peer {
    config["discovery"] = json!(port);
    let mut lrp = Peer::of::<Ev3>();
    lrp.configure(config);
    lrp
}

fn found(lrp: &mut Peer, bricks: usize) -> Vec<Found> {
    lrp.until("bricks", |event| match event {
        Event::Found { found } if found.len() == bricks => Some(found.clone()),
        _ => None,
    })
}

#[test]
fn the_only_brick_is_taken_and_answered() {
    let (port, brick) = (port(), Brick::start(0));
    let mut lrp = listening(port, json!({}));
    brick.call_out(port, "EV3", "0016533F0C1E");
    let seen = found(&mut lrp, 1);
    assert_eq!((&*seen[0].name, &*seen[0].what), ("EV3", "brick"));
    assert_eq!(seen[0].doc, format!("serial number 0016533F0C1E, at {}", brick.address));
    lrp.until_up();
    crate::peer::eventually("an answer", || brick.state().answered > 0);
    // It comes back to the same.
    brick.hang_up();
    assert_eq!(lrp.until_lost(), "the brick closed the connection");
    lrp.until_up();
    assert_eq!(brick.state().unlocked, 2);
    brick.end();
}

#[test]
fn a_brick_is_wanted_by_name_or_number() {
    for wanted in [json!({ "name": "Bob" }), json!({ "serial": "00:16:53:00:00:02" })] {
        let (port, other, bob) = (port(), Brick::start(0), Brick::start(0));
        let mut lrp = listening(port, wanted);
        other.call_out(port, "EV3", "001653000001");
        found(&mut lrp, 1);
        bob.call_out(port, "Bob", "001653000002");
        lrp.until_up();
        assert_eq!((bob.state().unlocked, other.state().unlocked), (1, 0));
        assert_eq!(other.state().answered, 0, "others are left alone");
        other.end();
        bob.end();
    }
}

#[test]
fn a_port_that_is_taken_is_told() {
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).expect("a socket");
    let port = socket.local_addr().expect("an address").port();
    let why = listening(port, json!({})).until_lost();
    assert!(why.starts_with(&format!("can't listen for bricks on UDP port {port}: ")), "{why}");
    assert!(why.ends_with("give the brick's `address` instead"), "{why}");
}

#[test]
fn what_is_no_beacon_is_not_a_brick() {
    let (port, brick) = (port(), Brick::start(0));
    let mut lrp = listening(port, json!({}));
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a socket");
    for junk in [&b""[..], b"\xff\xfe", b"Name: EV3\r\n", &[b'x'; 2000]] {
        socket.send_to(junk, (Ipv4Addr::LOCALHOST, port)).expect("sent");
    }
    brick.call_out(port, "EV3", "0016533F0C1E");
    lrp.until_up();
    brick.end();
}

#[test]
fn a_flood_of_beacons_is_bounded() {
    let port = port();
    let mut lrp = listening(port, json!({ "name": "nobody" }));
    lrp.until("listening", |event| matches!(event, Event::State { .. }).then_some(()));
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a socket");
    for number in 0..500 {
        let beacon = format!("Serial-Number: {number}\r\nPort: 1\r\nName: x\r\nProtocol: EV3\r\n");
        // The last of them may be the one too many for the socket.
        let _ = socket.send_to(beacon.as_bytes(), (Ipv4Addr::LOCALHOST, port));
        if number % 20 == 0 {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
    }
    found(&mut lrp, 64);
}
