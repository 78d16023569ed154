//! Definitions: the texts, and the descriptions that nodes give.

use lrp_bridge_ros2::types::description::definitions;
use lrp_bridge_ros2::types::parse::parts;
use lrp_bridge_ros2::types::{Count, Definition, Field, Kind, Registry, Scalar};
use proptest::prelude::*;
use serde_json::{Value, json};

use crate::peers;

fn message(text: &str) -> Definition {
    let mut parts = parts(text, "my_msgs").expect("a definition");
    assert_eq!(parts.len(), 1);
    parts.remove(0)
}

fn field(name: &str, kind: Kind<String>, count: Count, default: Option<Value>) -> Field<String> {
    Field { name: name.into(), kind, count, default }
}

#[test]
fn all_that_a_definition_can_say() {
    let text = "# about it all
float64 x            # metres, it's said
 int32\tN=0x10
string  WORD = \"a # b\"   # a comment
string BARE=two words
string<=10[<=5] names
string[] SHAPES [\"o\", 'a, b']
int8[3] three [1, -2, 3]
byte[] raw
wstring<=4 wide 'h\\'i'
bool on true
Vector3 own
geometry_msgs/Vector3 other
geometry_msgs/msg/Vector3[<=2] more
";
    let text_of = |bound| Kind::Text { wide: false, bound };
    let expected = Definition {
        fields: vec![
            field("x", Kind::Scalar(Scalar::F64), Count::One, None),
            field("names", text_of(Some(10)), Count::AtMost(5), None),
            field("SHAPES", text_of(None), Count::Any, Some(json!(["o", "a, b"]))),
            field("three", Kind::Scalar(Scalar::I8), Count::Exactly(3), Some(json!([1, -2, 3]))),
            field("raw", Kind::Scalar(Scalar::U8), Count::Any, None),
            field("wide", Kind::Text { wide: true, bound: Some(4) }, Count::One, Some(json!("h'i"))),
            field("on", Kind::Scalar(Scalar::Bool), Count::One, Some(json!(true))),
            field("own", Kind::Nested("my_msgs/msg/Vector3".into()), Count::One, None),
            field("other", Kind::Nested("geometry_msgs/msg/Vector3".into()), Count::One, None),
            field("more", Kind::Nested("geometry_msgs/msg/Vector3".into()), Count::AtMost(2), None),
        ],
        constants: vec![("N".into(), json!(16)), ("WORD".into(), json!("a # b")), ("BARE".into(), json!("two words"))],
    };
    assert_eq!(message(text), expected);
}

#[test]
fn mistakes_have_a_line_and_a_reason() {
    let says = |text: &str| parts(text, "p").expect_err("a mistake").to_string();
    assert_eq!(says("int8 a\nint8"), "line 2: `int8` has no name");
    assert_eq!(says("int8 a 300"), "line 1: the default of `a` can't be `300`");
    assert_eq!(says("int8[x] a"), "line 1: `x` is no count");
    assert_eq!(says("int8<=3 a"), "line 1: only strings have a longest length, `int8` hasn't");
    assert_eq!(says("int8 a\nbool a"), "line 2: `a` is declared twice");
    assert_eq!(says("a//b c"), "line 1: `a//b` is no type");
    assert_eq!(says("bool[2] a [true]"), "line 1: the default of `a` can't be `[true]`");
}

#[test]
fn types_that_cannot_be_are_refused() {
    let mut registry = Registry::new(Vec::new());
    let learn = |registry: &mut Registry, name: &str, text: &str| {
        registry.learn([(name.to_string(), parts(text, "p").expect("a definition").remove(0))]);
        registry.find(name).map(|_| ()).expect_err("no type")
    };
    assert_eq!(learn(&mut registry, "p/msg/A", "B b"), unknown("p/msg/B"));
    assert_eq!(learn(&mut registry, "p/msg/C", "C[] c"), "p/msg/C contains itself");
    assert_eq!(learn(&mut registry, "p/msg/D", "int8[4294967295] d"), "each p/msg/D has more than 4 MB");
    assert_eq!(
        registry.find("Twist").map(|_| ()),
        Err("`Twist` is no type: those are written as `geometry_msgs/msg/Twist`".to_string())
    );
}

fn unknown(name: &str) -> String {
    format!(
        "the type {name} is not known here: is its package installed (AMENT_PREFIX_PATH), or a node up that has it?"
    )
}

/// The descriptions of an installed ROS say what its texts say.
#[test]
fn descriptions_say_what_the_texts_say() {
    let Some(share) = peers::share() else { return };
    let mut count = 0;
    for package in ["geometry_msgs", "sensor_msgs", "std_msgs", "rcl_interfaces", "test_msgs", "visualization_msgs"] {
        for file in std::fs::read_dir(share.join(package).join("msg")).expect("a package") {
            let path = file.expect("a file").path();
            if path.extension().is_none_or(|extension| extension != "json") {
                continue;
            }
            let name = format!("{package}/msg/{}", path.file_stem().expect("a name").to_string_lossy());
            let described: Value = serde_json::from_slice(&std::fs::read(&path).expect("text")).expect("json");
            let described = definitions(&described["type_description_msg"]).expect(&name);
            let mut learnt = Registry::new(Vec::new());
            learnt.learn(described);
            let (learnt, written) = (learnt.find(&name), Registry::new(vec![share.clone()]).find(&name));
            let (learnt, written) = (learnt.expect(&name), written.expect(&name));
            assert_eq!(learnt.blank(), written.blank(), "{name}");
            assert_eq!(learnt.least, written.least, "{name}");
            count += 1;
        }
    }
    assert!(count > 100, "{count}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn any_text_is_a_definition_or_a_mistake(text in r#"([a-z]{1,6}[0-9]{0,2}|[ \t\n#"'\[\]<=,/_A-Z-]|string|wstring|uint8|float64|---){0,30}"#) {
        let _ = parts(&text, "p");
    }
}
