//! Frames against those that an independent client made, and whatever a brick may send.

use lrp_bridge_ev3::command::Command;
use lrp_bridge_ev3::motor::{self, Halt, Motor, Motors, Way};
use lrp_bridge_ev3::orders::{self, Deed};
use lrp_bridge_ev3::poll::{Poll, Sensor, World};
use lrp_bridge_ev3::settings::Settings;
use lrp_bridge_ev3::{discovery, frame, link};
use proptest::prelude::*;
use serde_json::{Value, json};

use crate::peer::hex;

fn vectors() -> Value {
    serde_json::from_str(include_str!("../vectors/ev3.json")).expect("vectors")
}

fn motors(letters: &str) -> Motors {
    let motors = letters.chars().filter_map(|letter| Motor::of_letter(&letter.to_string()));
    motors.fold(Motors::NONE, Motors::and)
}

fn called(call: &str, arguments: Value) -> Command {
    let settings = Settings::read(&json!({})).expect("settings");
    match orders::read(call, arguments.as_array().expect("arguments"), &settings) {
        Ok(Deed::Send { command, .. } | Deed::Move { command, .. }) => command,
        other => panic!("{call}: {other:?}"),
    }
}

/// A command of which the bridge has no use: its operations written down.
fn written(write: impl FnOnce(&mut Command)) -> Command {
    let mut command = Command::default();
    write(&mut command);
    command
}

fn input(command: &mut Command, sub: u8, numbers: &[i32], word: bool) {
    command.op(0x99).op(sub).numbers(numbers);
    if word {
        command.word()
    } else {
        command.byte()
    };
}

/// The bridge's own command where it has one, else the same operations through its encoder.
fn command(name: &str) -> Command {
    match name {
        "motor_power_start_A50" => called("motorA.startAtPower", json!([50])),
        "motor_speed_start_A50" | "motor_speed_start_A50_sync" => called("motorA.startAtSpeed", json!([50])),
        "motor_speed_start_BC_neg100" => motor::start_at_speed(motors("BC"), -100),
        "motor_stop_A_coast" => called("motorA.stop", json!(["coast"])),
        "motor_stop_A_brake" | "hl_motor_stop" => called("motorA.stop", json!(["brake"])),
        "stop_all_brake" => called("fullStop", json!([])),
        "input_stop_all" => written(|command| _ = command.op(0x99).op(0x0d).number(0)),
        "motor_step_speed_B" => called("motorB.moveBy", json!([360, 50, "brake", 10])),
        "motor_step_power_B" => written(|command| _ = command.op(0xac).numbers(&[0, 2, -50, 0, 180, 0, 0])),
        "motor_time_speed_AD" => motor::turn(motors("AD"), 75, Way::Milliseconds(2000), 100, Halt::Brake),
        "motor_time_sync_BC_turn" => called("motorB.runWith", json!(["C", 1500, 40, -100, "coast"])),
        "motor_ready_A" => written(|command| _ = command.op(0xaa).numbers(&[0, 1])),
        "motor_test_ABCD" => written(|command| _ = command.op(0xa9).numbers(&[0, 15]).byte()),
        "motor_clr_count_ABCD" => written(|command| _ = command.op(0xb2).numbers(&[0, 15])),
        "motor_get_count_B" => written(|command| _ = command.op(0xb3).numbers(&[0, 1]).word()),
        "sensor_read_pct_1" => written(|command| _ = command.op(0x9a).numbers(&[0, 0, 0, 0]).byte()),
        "sensor_read_si_2_mode_keep" => written(|command| _ = command.op(0x9d).numbers(&[0, 1, 0, -1]).word()),
        "sensor_ready_si_color_mode2" => written(|command| input(command, 0x1d, &[0, 2, 29, 2, 1], true)),
        "sensor_ready_pct_touch1" => written(|command| input(command, 0x1b, &[0, 0, 16, 0, 1], false)),
        "sensor_get_typemode_4" => written(|command| {
            input(command, 0x05, &[0, 3], false);
            command.byte();
        }),
        "sensor_device_list" => written(|command| _ = command.op(0x98).number(32).op(0x60).op(0xe1).op(32)),
        "sensor_clr_all" => written(|command| _ = command.op(0x99).op(0x0a).number(0)),
        "sound_tone_440_500ms" => called("tone", json!([440, 500, 50])),
        "sound_play" => called("play", json!(["../prjs/t/beep", 100])),
        "led_red_flash" => called("led", json!(["red-flashing"])),
        "button_pressed_enter" => written(|command| _ = command.op(0x83).op(9).number(2).byte()),
        "battery" | "hl_battery" => written(|command| {
            command.op(0x81).op(1).word();
            command.op(0x81).op(2).word();
            command.op(0x81).op(0x12).byte();
        }),
        "keep_alive" => written(|command| _ = command.op(0x90).byte()),
        "set_brickname" => written(|command| _ = command.op(0xd4).number(8).text("myEV3")),
        "fw_version" => written(|command| _ = command.op(0x81).op(0x0a).number(16).op(0x60)),
        "nop_local_mem" => written(|command| _ = command.op(0x01)),
        "enc_edges" => written(|command| {
            for number in [-32, -33, 31, 32, 127, -127, 128, -32767, 32768] {
                command.op(0x3a).number(number).op(0x40);
            }
        }),
        "hl_touch_touched" => written(|command| input(command, 0x1d, &[0, 0, 16, 0, 1], true)),
        "hl_touch_bumps" => written(|command| input(command, 0x1d, &[0, 0, 16, 1, 1], true)),
        "hl_color_reflected" => written(|command| input(command, 0x1b, &[0, 1, 29, 0, 1], false)),
        "hl_color_color" => written(|command| input(command, 0x1c, &[0, 1, 29, 2, 1], true)),
        "hl_us_distance" => written(|command| input(command, 0x1c, &[0, 2, 5, 0, 1], true)),
        "hl_motor_init" => called("motorA.reset", json!([])),
        "hl_motor_start_move" => written(|command| {
            command.then(&written(|command| _ = command.op(0xaf).numbers(&[0, 1, 50, 100, i32::MAX, 0, 0])));
            command.op(0xa6).numbers(&[0, 1]);
        }),
        "hl_motor_busy" => written(|command| _ = command.op(0xa9).numbers(&[0, 1]).byte()),
        "hl_motor_position" => written(|command| input(command, 0x1d, &[0, 16, 7, 0, 1], true)),
        "hl_volume" => written(|command| _ = command.op(0x7c).op(5).number(20)),
        "hl_led" => called("led", json!(["orange"])),
        "hl_tone" => called("tone", json!([440, 1000, 100])),
        _ => panic!("no command for `{name}`"),
    }
}

/// They answer lists or have variables of their own, of which the bridge has none: only what they say is compared.
const LISTS: [&str; 4] = ["sensor_device_list", "fw_version", "nop_local_mem", "enc_edges"];

fn bytes(hex: &str) -> Vec<u8> {
    (0..hex.len()).step_by(2).map(|at| u8::from_str_radix(&hex[at..at + 2], 16).expect("hex")).collect()
}

#[test]
fn every_frame_is_that_of_an_independent_client() {
    let vectors = vectors();
    let vectors = vectors["vectors"].as_array().expect("a list");
    for vector in vectors {
        let (name, wanted) = (vector["name"].as_str().expect("a name"), vector["frame"].as_str().expect("a frame"));
        let number = |key: &str| vector[key].as_u64().expect("a number");
        let (counter, kind) = (number("counter") as u16, number("type") as u8);
        let made = if let Some(system) = vector["sys_cmd"].as_u64() {
            let payload = bytes(vector["payload"].as_str().expect("bytes"));
            frame::frame(counter, kind, &[&[system as u8], &*payload].concat())
        } else if name == "hl_ir_distance" {
            // That client wrote a variable where the number of the sensor is meant.
            let right = written(|command| input(command, 0x1c, &[0, 3, 33, 0, 1], true));
            assert_eq!(hex(right.ops()), vector["ops"].as_str().expect("bytes").replace("e121", "8121"));
            continue;
        } else if LISTS.contains(&name) {
            let header = (number("globals") | number("locals") << 10) as u16;
            frame::frame(counter, kind, &[&header.to_le_bytes(), command(name).ops()].concat())
        } else {
            // The bridge wants each command answered, so that it hears of errors.
            let mut made = frame::command(counter, &command(name));
            assert_eq!(made[4], 0, "{name}");
            made[4] = kind;
            made
        };
        assert_eq!(hex(&made), wanted, "{name}");
    }
    assert_eq!(vectors.len(), 51);
}

#[test]
fn the_unlock_is_what_bricks_look_for() {
    let wanted =
        vectors()["handshake"]["unlock"].as_str().expect("a text").replace("00:16:53:3F:0C:1E", "0016533F0C1E");
    assert_eq!(String::from_utf8(link::unlock("0016533F0C1E")).as_deref(), Ok(&*wanted));
}

#[test]
fn beacons() {
    let from = "192.168.0.17:41000".parse().expect("an address");
    let beacon = bytes(vectors()["handshake"]["beacon_hex"].as_str().expect("bytes"));
    let brick = discovery::beacon(&beacon, from).expect("a brick");
    assert_eq!(
        (&*brick.name, &*brick.serial, brick.address.to_string()),
        ("EV3", "0016533F0C1E", "192.168.0.17:5555".into())
    );
    for wrong in ["", "Protocol: EV3", "Serial-Number: 1\r\nPort: 99999\r\nName: x\r\nProtocol: EV3\r\n"] {
        assert_eq!(discovery::beacon(wrong.as_bytes(), from), None, "{wrong}");
    }
}

#[test]
fn replies() {
    for vector in vectors()["vectors"].as_array().expect("a list") {
        let Some(reply) = vector["lms2012_reply"].as_str().filter(|reply| !reply.is_empty()) else { continue };
        let (reply, direct) = (bytes(reply), vector.get("sys_cmd").is_none());
        let read = frame::reply(&reply[2..]);
        assert_eq!(read.map(|reply| u64::from(reply.counter)), direct.then(|| vector["counter"].as_u64()).flatten());
    }
}

/// The opcodes that keep a brick from reading on. The bridge's own commands have none of them, whatever a program calls.
#[test]
fn reading_everything_fits_into_one_frame_and_cannot_block() {
    let crowded = Sensor { kind: 33, mode: 1, ..Sensor::default() };
    let world = World { sensors: std::array::from_fn(|_| crowded.clone()), ..World::default() };
    let poll = Poll::after(&world);
    assert!(poll.command.ops().len() < 900 && poll.command.globals() < 1000, "{:?}", poll.command);
    let mut machine = lrp_fake_ev3::Machine::default();
    machine.plug(1, 33, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    let mut answer = vec![0; poll.command.globals().into()];
    assert!(machine.run(poll.command.ops(), &mut answer).is_ok());
    assert_eq!(machine.blocked, 0);
    let values: Vec<f32> = poll.read(&answer).sensors[0].values.iter().map(|value| value.expect("a value")).collect();
    assert_eq!(values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
}

proptest! {
    #[test]
    fn whatever_a_brick_sends_is_read_as_far_as_it_goes(
        bytes in proptest::collection::vec(any::<u8>(), 0..400),
        kinds in proptest::array::uniform4(any::<u8>()),
        modes in proptest::array::uniform4(any::<u8>()),
    ) {
        let mut world = World::default();
        for (sensor, (kind, mode)) in world.sensors.iter_mut().zip(kinds.into_iter().zip(modes)) {
            (sensor.kind, sensor.mode) = (kind, mode);
        }
        let _ = frame::reply(&bytes);
        let _ = discovery::beacon(&bytes, "127.0.0.1:1".parse().expect("an address"));
        let read = Poll::after(&world).read(&bytes);
        for sensor in read.sensors {
            prop_assert!(sensor.values.iter().flatten().all(|value| value.is_finite()));
        }
    }

    #[test]
    fn whatever_a_program_calls_is_done_or_refused(
        device in "(motor[A-E]|sensor[0-5])\\.(start|startAtPower|stop|moveBy|moveTo|runFor|startWith|moveWith|runWith|setMode|reset|x)",
        numbers in proptest::collection::vec(prop_oneof![any::<f64>().prop_map(Value::from), Just(json!("A")), Just(json!("brake"))], 0..6),
    ) {
        let settings = Settings::read(&json!({})).expect("settings");
        if let Ok(Deed::Send { command, .. } | Deed::Move { command, .. }) = orders::read(&device, &numbers, &settings) {
            let mut machine = lrp_fake_ev3::Machine::default();
            prop_assert!(machine.run(command.ops(), &mut []).is_ok(), "{device} {numbers:?}");
            prop_assert_eq!(machine.blocked, 0);
        }
    }
}
