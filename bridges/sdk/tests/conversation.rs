//! A bridge as lrp hears it: what it is asked in which order, and how it ends.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use lrp_bridge::{
    About, Active, Bridge, Call, Description, Event, Form, Item, Level, News, Order, Output, Peer, Port, Problem,
    Robot, Scope, Variable, Want, value,
};
use serde_json::{Value, json};

/// Writes down what it is told. An output `wait` keeps it busy until the number in its message has been told to stop.
struct Diary {
    robot: Robot,
    told: Vec<String>,
}

static STOPS: Mutex<u32> = Mutex::new(0);

impl Bridge for Diary {
    fn about() -> About {
        About { kind: "diary".into(), version: "1.2.3".into(), summary: "keeps a diary".into(), ..About::default() }
    }

    fn offer(config: &Value) -> Result<Description, Vec<Problem>> {
        match config.get("wrong") {
            Some(_) => Err(vec![Problem::new("`wrong` is wrong").at("wrong").help("leave it out")]),
            None => Ok(Description {
                outputs: vec![Port::new("page", json!({}), "")],
                scope: Scope::Open,
                ..Description::default()
            }),
        }
    }

    fn connect(robot: Robot, form: Form) -> Diary {
        robot.up();
        Diary { robot, told: vec![format!("connect {}", form.config)] }
    }

    fn configure(&mut self, form: Form) {
        self.told.push(format!("configure {}", form.config));
    }

    fn send(&mut self, output: &str, message: Value) {
        match output {
            "wait" => std::thread::sleep(Duration::from_millis(200)),
            "panic" => panic!("as asked"),
            _ => self.told.push(format!("{output} {message}")),
        }
    }

    fn call(&mut self, call: Call) {
        match &*call.call {
            "read" => self.robot.reply(call.id, Ok(json!(self.told))),
            _ => self.robot.reply(call.id, Err(format!("no `{}`", call.call))),
        }
    }

    fn cancel(&mut self, id: u64) {
        self.told.push(format!("cancel {id}"));
    }

    fn flush(&mut self) {
        self.told.push("flush".into());
    }

    fn hear(&mut self, news: News) {
        self.told.push(format!("{news:?}"));
    }

    fn stop(&mut self) {
        *STOPS.lock().unwrap() += 1;
        self.told.push("stop".into());
    }
}

fn diary() -> Peer {
    let mut lrp = Peer::of::<Diary>();
    lrp.configure(json!({}));
    lrp.until_up();
    lrp
}

fn told(lrp: &mut Peer) -> Value {
    let read = lrp.call("read", Vec::new());
    lrp.reply(read).expect("its pages")
}

#[test]
fn it_says_hello_first() {
    let mut lrp = Peer::of::<Diary>();
    let Some(Event::Hello { protocol, about }) = lrp.event(Duration::from_secs(10)) else { panic!("no hello") };
    assert_eq!((protocol, &*about.kind, &*about.version), (1, "diary", "1.2.3"));
}

#[test]
fn it_is_told_everything_in_order() {
    let mut lrp = diary();
    let output = |value| Item::Output(Output { output: "page".into(), value });
    let call = Item::Call(Call { call: "nothing".into(), id: 9, arguments: Vec::new() });
    lrp.order(Order::Send { items: vec![output(json!(1)), call, output(json!(2))] });
    assert_eq!(lrp.reply(9), Err("no `nothing`".into()));
    lrp.configure(json!({ "a": 1 }));
    assert_eq!(told(&mut lrp), json!(["connect {}", "page 1", "page 2", "flush", "configure {\"a\":1}"]));
}

#[test]
fn news_arrive_as_they_were_told() {
    let mut lrp = diary();
    let variables = vec![Variable { path: "follower/speed".into(), value: json!([0.5, "fast", null]) }];
    let machines = vec![Active { machine: "follower".into(), state: "moving".into(), since: 12.5 }];
    let (t, level, message, state) = (20.25, Level::Warn, "slow".to_string(), Some("follower/moving".to_string()));
    for order in [
        Order::Cancel { id: 3 },
        Order::Answer { id: 4, error: None },
        Order::Answer { id: 5, error: Some("no such variable".into()) },
        Order::Variables { variables: variables.clone() },
        Order::States { t, machines: machines.clone() },
        Order::Log { level, message: message.clone(), state: state.clone() },
        Order::Log { level: Level::Debug, message: message.clone(), state: None },
    ] {
        lrp.order(order);
    }
    let news = [
        News::Answer { id: 4, error: None },
        News::Answer { id: 5, error: Some("no such variable".into()) },
        News::Variables(variables),
        News::States { t, machines },
        News::Log { level, message: message.clone(), state },
        News::Log { level: Level::Debug, message, state: None },
    ];
    let pages = ["connect {}".to_string(), "cancel 3".to_string()];
    let pages: Vec<String> = pages.into_iter().chain(news.iter().map(|news| format!("{news:?}"))).collect();
    assert_eq!(told(&mut lrp), json!(pages));
}

#[test]
fn a_stop_overtakes_what_waits_to_be_sent() {
    let mut lrp = diary();
    lrp.send("wait", Value::Null);
    for page in 0..100 {
        lrp.send("page", json!(page));
    }
    lrp.order(Order::Stop);
    lrp.until("`stopped`", |event| (*event == Event::Stopped).then_some(()));
    let told = told(&mut lrp);
    let pages = told
        .as_array()
        .expect("pages")
        .iter()
        .filter(|page| page.as_str().is_some_and(|page| page.starts_with("page")));
    assert!(pages.count() < 100, "what was sent before the stop is undone: {told}");
    assert_eq!(told.as_array().and_then(|all| all.last()), Some(&json!("stop")), "nothing is sent after it");
}

#[test]
fn a_call_that_a_stop_undoes_is_over() {
    let mut lrp = diary();
    lrp.send("wait", Value::Null);
    let call = lrp.call("read", Vec::new());
    lrp.order(Order::Stop);
    assert_eq!(lrp.reply(call), Err("given up before it began".to_string()));
}

#[test]
fn a_wrong_configuration_changes_nothing() {
    let mut lrp = diary();
    lrp.configure(json!({ "wrong": true }));
    let problems = lrp.until("problems", |event| match event {
        Event::Offer { problems, .. } if !problems.is_empty() => Some(problems.clone()),
        _ => None,
    });
    assert_eq!(problems, [Problem::new("`wrong` is wrong").at("wrong").help("leave it out")]);
    assert_eq!(told(&mut lrp), json!(["connect {}"]));
}

#[test]
fn it_describes_itself_without_connecting() {
    let mut lrp = Peer::of::<Diary>();
    lrp.order(Order::Describe { config: json!({}) });
    assert_eq!(lrp.offer().outputs.len(), 1);
    lrp.order(Order::Ping { id: 4 });
    let seen = lrp.until("pong", |event| match event {
        Event::Pong { id } => Some(*id),
        Event::State { .. } => panic!("it connected"),
        _ => None,
    });
    assert_eq!(seen, 4);
}

#[test]
fn without_lrp_it_stops_its_robot_and_ends() {
    let before = *STOPS.lock().unwrap();
    assert_eq!(diary().close(), 0);
    assert!(*STOPS.lock().unwrap() > before);
}

#[test]
fn a_panic_stops_the_robot_and_ends_it() {
    let mut lrp = diary();
    lrp.send("panic", Value::Null);
    while lrp.event(Duration::from_secs(10)).is_some() {}
    assert_eq!(lrp.close(), 101);
}

#[test]
fn what_it_does_not_know_is_left_out() {
    let mut lrp = diary();
    for line in
        [r#"{"order":"dance","id":1}"#, "", "[]", "{", r#"{"order":"ping"}"#, r#"{"order":"ping","id":1,"and":"more"}"#]
    {
        lrp.line(line);
    }
    let Some(Event::Pong { id: 1 }) = lrp.event(Duration::from_secs(10)) else { panic!("no pong, or another one") };
    lrp.line(r#"{"order":"answer","id":1,"error":5}"#);
    lrp.line(r#"{"order":"send","items":[{"dance":1},{"output":"page","value":1}]}"#);
    assert_eq!(told(&mut lrp), json!(["connect {}", "page 1", "flush"]));
    let hello =
        r#"{"event":"hello","protocol":1,"kind":"odd","version":"1","summary":"","wants":["states","applause"]}"#;
    let Ok(Event::Hello { about, .. }) = serde_json::from_str(hello) else { panic!("it is one") };
    assert_eq!(about.wants, [Want::States, Want::Unknown]);
}

/// Says more than anybody can read.
struct Flood {
    over: Arc<Mutex<bool>>,
}

impl Bridge for Flood {
    fn about() -> About {
        About { kind: "flood".into(), ..About::default() }
    }

    fn offer(_: &Value) -> Result<Description, Vec<Problem>> {
        Ok(Description::default())
    }

    fn connect(robot: Robot, _: Form) -> Flood {
        for number in 0..200_000 {
            robot.input("count", number);
        }
        robot.input("end", true);
        robot.up();
        Flood { over: Arc::default() }
    }

    fn configure(&mut self, _: Form) {}

    fn send(&mut self, _: &str, _: Value) {}

    fn stop(&mut self) {
        *self.over.lock().unwrap() = true;
    }
}

#[test]
fn of_what_comes_too_fast_the_latest_is_told_and_the_rest_counted() {
    let mut lrp = Peer::of::<Flood>();
    lrp.configure(json!({}));
    let (mut messages, mut skipped) = (0, 0);
    lrp.until("last count", |event| match event {
        Event::Input { name, value, skipped: more } if name == "count" => {
            (messages, skipped) = (messages + 1, skipped + more);
            (*value == json!(199_999)).then_some(())
        }
        _ => None,
    });
    assert_eq!(messages + skipped, 200_000);
    assert!(skipped > 0, "a pipe can't take all of them");
}

#[test]
fn what_json_has_no_word_for() {
    for bytes in [&b""[..], b"a", b"ab", b"abc", b"abcd", &[0, 255, 128, 7, 0]] {
        assert_eq!(value::as_bytes(&value::bytes(bytes)).as_deref(), Some(bytes));
    }
    assert_eq!(value::bytes(b"hello\n"), json!({ "lua": "bytes", "base64": "aGVsbG8K" }));
    assert_eq!(value::as_bytes(&json!("text")).as_deref(), Some(&b"text"[..]));
    assert_eq!(value::as_bytes(&json!({ "lua": "bytes", "base64": "a?" })), None);
    for number in [0.5, -3.0, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(value::as_number(&value::number(number)), Some(number));
    }
    assert!(value::as_number(&value::number(f64::NAN)).is_some_and(f64::is_nan));
}
