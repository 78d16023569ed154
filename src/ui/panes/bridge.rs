//! The robots: how each connection is, what comes and goes with value, age and rate, calls, devices, what is seen there.

use lrp_bridge::Health;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::{Title, draw_nothing};
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::layout::Pane;
use crate::ui::pen::Pen;
use crate::ui::robots::{Row, What};
use crate::ui::view::{Bridge, Call, Message};

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Title {
    let rows = app.robot_rows();
    if rows.is_empty() {
        draw_nothing(app, area, buffer, "No robot: `(bridge robot KIND)` in the program brings one.");
    }
    let top = app.robots_top();
    for (y, row) in (0..area.height).zip(rows.iter().skip(top)) {
        draw_row(app, row, Pen::new(buffer, area, y));
    }
    let hidden = rows.len().saturating_sub(top + usize::from(area.height));
    let note = if hidden > 0 { format!("{hidden} more") } else { String::new() };
    let filter = app.robots_filter();
    let title = if filter.is_empty() { String::new() } else { format!("  /{filter}") };
    Title::new(format!("{}{title}", Pane::Bridge.title()), note)
}

fn draw_row(app: &App, row: &Row, mut pen: Pen) {
    let theme = app.theme();
    let selected = row.key().is_some() && row.key().as_ref() == app.selected_robot_row();
    let names = (pen.room() / 4).clamp(8, 20);
    pen.put(if selected { glyphs::HERE } else { " " }, theme.bold());
    match &row.what {
        What::Robot(bridge) => draw_robot(app, row.robot, bridge, &mut pen),
        What::Heading(heading) => _ = pen.put(heading, theme.dim()),
        What::Input { name, message, type_name } => {
            pen.put(" ", theme.normal()).column(name, names, theme.normal());
            draw_message(app, *message, type_name, &mut pen);
        }
        What::Output { name, message, type_name, .. } => {
            pen.put(glyphs::RIGHT, theme.dim()).column(name, names, theme.normal());
            draw_message(app, *message, type_name, &mut pen);
        }
        What::Call(_, call) => draw_call(app, call, &mut pen),
        What::Function(function) => {
            let arguments: Vec<&str> = function.arguments.iter().map(|argument| argument.name.as_str()).collect();
            let call = format!("{}({})", function.name, arguments.join(", "));
            pen.put(" ", theme.normal()).put(&call, theme.normal()).put("  ", theme.normal());
            pen.put(&function.doc, theme.dim());
        }
        What::Device(device) => {
            let functions: Vec<&str> = device.functions.iter().map(|function| function.name.as_str()).collect();
            pen.put(" ", theme.normal()).put(&device.name, theme.normal()).put("  ", theme.normal());
            pen.put(&functions.join(" "), theme.dim());
        }
        What::Found(found) => {
            pen.put(" ", theme.normal()).column(&found.name, names + 4, theme.normal());
            let what = if found.type_name.is_empty() { &found.what } else { &found.type_name };
            pen.put(" ", theme.normal()).put(what, theme.dim()).put("  ", theme.dim()).put(&found.doc, theme.dim());
        }
    }
    if selected && app.focus() == Pane::Bridge {
        pen.wash(theme.selected());
    }
}

fn draw_robot(app: &App, name: &str, bridge: &Bridge, pen: &mut Pen) {
    let theme = app.theme();
    let health = match bridge.health {
        Some(Health::Up) => "up",
        Some(Health::Connecting) => "connecting",
        Some(Health::Lost) => "LOST",
        None => "",
    };
    pen.put(name, theme.bold()).put("  ", theme.normal()).put(&bridge.kind, theme.normal()).put("  ", theme.normal());
    let calls = bridge.in_flight();
    if calls > 0 && bridge.message.is_none() {
        pen.put_right(&format!("  {calls} call{} in flight", if calls == 1 { "" } else { "s" }), theme.dim());
    }
    pen.put(health, theme.health(bridge.health)).put("  ", theme.normal());
    match &bridge.message {
        Some(message) => pen.put(message, theme.normal()),
        None => {
            let since = format::duration(app.shown_at().t.since(bridge.since).ms());
            pen.put(&format!("for {since}"), theme.dim())
        }
    };
}

/// Its age and how many come a second at the right, the value in the room that is left.
fn draw_message(app: &App, message: Option<&Message>, type_name: &str, pen: &mut Pen) {
    let theme = app.theme();
    let Some(message) = message else {
        pen.put("none yet", theme.dim()).put("  ", theme.dim()).put(type_name, theme.dim());
        return;
    };
    let rate = if message.rate > 0.0 { format!("{}/s", format::number(message.rate.round())) } else { String::new() };
    let age = format::duration(app.shown_at().t.since(message.at).ms());
    pen.put_right(" ", theme.dim()).right_column(&rate, 6, theme.dim()).right_column(&age, 9, theme.dim());
    pen.put(&format::message(&message.value), theme.normal());
}

fn draw_call(app: &App, call: &Call, pen: &mut Pen) {
    let theme = app.theme();
    let arguments: Vec<String> = call.arguments.as_array().into_iter().flatten().map(format::value).collect();
    pen.put(" ", theme.normal()).put(&format!("{}({})", call.name, arguments.join(", ")), theme.normal());
    pen.put("  ", theme.normal());
    let took = |end| format::duration(crate::runtime::time::Time::since(end, call.begun).ms());
    match (&call.ended, &call.feedback) {
        (Some((end, Ok(value))), _) => {
            pen.put_right(" ", theme.dim()).put_right(&format!("  {}", took(*end)), theme.dim());
            let value = if value.is_null() { String::new() } else { format!(": {}", format::value(value)) };
            pen.put("done", theme.active()).put(&value, theme.normal());
        }
        (Some((end, Err(error))), _) => {
            pen.put_right(" ", theme.dim()).put_right(&format!("  {}", took(*end)), theme.dim());
            pen.put("failed: ", theme.stop()).put(error, theme.normal());
        }
        (None, feedback) => {
            pen.put_right(" ", theme.dim()).put_right(&format!("  {}", took(app.shown_at().t)), theme.dim());
            pen.put("in flight", theme.fresh());
            if let Some(feedback) = feedback {
                pen.put("  ", theme.normal()).put(&format::value(feedback), theme.normal());
            }
        }
    }
}
