use lrp::lua::*;
use serde_json::json;

#[test]
fn order_probe() {
    let mut lua = Lua::new(Limits::default(), Access::Sandboxed, 1);
    let b = lua.compile("local t, s = {}, {} for i = 1, 24 do t['key' .. i] = i end for k in next, t do s[#s + 1] = k end return table.concat(s, ' ')", &[]).unwrap();
    println!("{}", lua.eval(b).unwrap());
    let x = lua.cell();
    let b = lua
        .compile("x = {1,2,{a=3}} return x", &[("x", x)])
        .unwrap();
    assert_eq!(lua.eval(b).unwrap(), json!([1,2,{"a":3}]));
    assert!(lua.changed(x));
    assert!(!lua.changed(x));
    let b = lua
        .compile(
            "while true do pcall(function() while true do end end) end",
            &[("x", x)],
        )
        .unwrap();
    assert_eq!(lua.run(b), Ran::Failed);
    println!("{:?}", lua.take_failure());
    let b = lua.compile("return y", &[("yy", x)]).unwrap();
    assert_eq!(lua.run(b), Ran::Failed);
    println!("{:?}", lua.take_failure());
}
