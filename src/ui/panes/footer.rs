//! The last line: what the keys do here, or a sentence, or the value being typed. How to stop the robot is always in it.

use std::ops::Range;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use tui_input::Input;
use unicode_width::UnicodeWidthChar;

use super::draw_words;
use crate::ui::action::{Action, Entry};
use crate::ui::app::{App, Goal, Help, Overlay, Palette, SearchLine, Text, Typing};
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::key::Key;
use crate::ui::layout::Pane;
use crate::ui::pen::Pen;
use crate::ui::view::{Mode, name};
use crate::ui::words;

/// What a person can take hold of in it.
#[derive(Debug, Default)]
pub struct Footer {
    /// Where the cursor stands, when there is one.
    pub cursor: Option<Position>,
    /// What clicks do there, with the columns.
    pub actions: Vec<(Range<u16>, Action)>,
}

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Footer {
    let theme = app.theme();
    let typing = match app.overlay() {
        Overlay::Typing(typing) => Some(typing),
        _ => None,
    };
    if let Some((typing, message)) = typing.zip(app.message()) {
        draw_mistake(app, typing, message, area, buffer);
    }
    let prompt = match app.overlay() {
        Overlay::Typing(typing) => Some(Prompt::of_typing(typing)),
        Overlay::Palette(palette) => Some(Prompt::of_palette(palette)),
        Overlay::Help(help) if help.line == SearchLine::Open => Some(Prompt::of_help(help)),
        _ => None,
    };
    let mut footer = Footer::default();
    let mut pen = Pen::new(buffer, area, 0);
    pen.put_right(" ", theme.normal());
    let (keys, end) = (app.keys(), pen.end());
    let stop = if prompt.is_some() { keys.name_always(Action::Runstop) } else { keys.name(Action::Runstop) };
    pen.put_right(" STOP", theme.stop()).put_right(&stop, theme.stop());
    footer.actions.push((pen.end()..end, Action::Runstop));
    pen.put_right("  ", theme.normal());
    pen.put(" ", theme.normal());
    match (prompt, app.message()) {
        (Some(prompt), _) => footer.cursor = Some(draw_prompt(app, &prompt, pen, area)),
        (None, Some(message)) => _ = pen.put(message, theme.bold()),
        (None, None) => match app.overlay() {
            Overlay::Help(_) => draw_given(app, HELP, &mut pen, &mut footer),
            Overlay::Held { .. } => draw_given(app, HELD, &mut pen, &mut footer),
            Overlay::Breakpoints { .. } => draw_given(app, BREAKPOINTS, &mut pen, &mut footer),
            Overlay::Menu(_) => draw_given(app, MENU, &mut pen, &mut footer),
            Overlay::Nothing | Overlay::Typing(_) | Overlay::Palette(_) => draw_keys(app, &mut pen, &mut footer),
        },
    }
    footer
}

const HELP: &[(Action, &str)] = &[(Action::Back, "back"), (Action::Search, "find")];
const HELD: &[(Action, &str)] = &[
    (Action::Back, "back"),
    (Action::ApplyHeld, "apply"),
    (Action::DropHeld, "drop"),
    (Action::SwitchOnEdit, "restart or keep"),
];
const BREAKPOINTS: &[(Action, &str)] =
    &[(Action::Back, "back"), (Action::ToggleBreakpoint, "clear"), (Action::DropHeld, "clear all")];
const MENU: &[(Action, &str)] = &[(Action::Into, "does it"), (Action::Back, "back")];

fn draw_given(app: &App, keys: &[(Action, &str)], pen: &mut Pen, footer: &mut Footer) {
    for (action, label) in keys {
        let key = app.keys().name(*action);
        if pen.room() >= format::width(&key) + 1 + format::width(label) {
            footer.actions.push((draw_key(app, &key, label, pen), *action));
        }
    }
}

/// A line to type in: what for, what is there, and how it ends.
struct Prompt<'a> {
    before: String,
    sign: &'static str,
    input: &'a Input,
    text: Text,
    hint: &'static str,
}

impl<'a> Prompt<'a> {
    fn of_typing(typing: &'a Typing) -> Prompt<'a> {
        let (before, sign) = match &typing.goal {
            Goal::Value(var) => (var.to_string(), " = "),
            Goal::Filter(Pane::Log) => ("lines with".into(), " "),
            Goal::Filter(Pane::Bridge) => ("seen there, called".into(), " "),
            Goal::Filter(_) => ("variables called".into(), " "),
            Goal::Words => ("find".into(), " "),
            Goal::Tell(robot) => (robot.to_string(), "."),
            Goal::Setting(robot) => (format!("into (bridge {robot} ..)"), " "),
            Goal::Condition(machine) if machine.is_empty() => ("pause when".into(), " "),
            Goal::Condition(machine) => (format!("{}: pause when", name(machine)), " "),
        };
        let hint = match typing.goal {
            Goal::Filter(_) => "Enter keeps  Esc shows all",
            Goal::Tell(_) => "Enter sends  Esc leaves",
            Goal::Setting(_) => "Enter writes it  Esc leaves",
            Goal::Words => "Enter goes there  Esc leaves",
            Goal::Value(_) | Goal::Condition(_) => "Enter sets  Esc leaves",
        };
        Prompt { before, sign, input: &typing.input, text: typing.text, hint }
    }

    fn of_help(help: &'a Help) -> Prompt<'a> {
        let hint = "Enter keeps  Esc shows all";
        Prompt { before: "keys for".into(), sign: " ", input: &help.search, text: Text::Typed, hint }
    }

    fn of_palette(palette: &'a Palette) -> Prompt<'a> {
        let hint = "Enter does it  Esc leaves";
        Prompt { before: String::new(), sign: ":", input: &palette.input, text: Text::Typed, hint }
    }
}

fn draw_prompt(app: &App, prompt: &Prompt, mut pen: Pen, area: Rect) -> Position {
    let theme = app.theme();
    if pen.room() >= 58 {
        pen.put_right(prompt.hint, theme.dim()).put_right("  ", theme.dim());
    }
    pen.put(&format::fit(&prompt.before, pen.room() / 2), theme.bold()).put(prompt.sign, theme.dim());
    let (start, room) = (pen.at(), pen.room().saturating_sub(1));
    let scroll = prompt.input.visual_scroll(usize::from(room));
    let style = match prompt.text {
        Text::Present => theme.selected(),
        Text::Typed => theme.normal(),
    };
    pen.put(&after_columns(prompt.input.value(), scroll), style);
    let cursor = prompt.input.visual_cursor().saturating_sub(scroll) as u16;
    Position::new(start.saturating_add(cursor).min(area.right().saturating_sub(1)), area.y)
}

/// In the rows above the line, without the words that stand in it.
fn draw_mistake(app: &App, typing: &Typing, message: &str, area: Rect, buffer: &mut Buffer) {
    let typed = format!("`{}`: ", typing.input.value().trim());
    let lines = format::wrap(message.strip_prefix(&typed).unwrap_or(message), area.width.saturating_sub(2));
    // Never over the first line, which says whether the robot may move.
    let first = area.y.saturating_sub(lines.len() as u16).max(1);
    for (y, line) in (first..area.y).zip(&lines) {
        let style = app.theme().stop();
        Pen::new(buffer, Rect { y, ..area }, 0).put(" ", style).put(line, style).fill(" ", Style::reset());
    }
}

fn after_columns(text: &str, columns: usize) -> String {
    let mut skipped = 0;
    let rest = text.chars().skip_while(|c| {
        let out = skipped < columns;
        skipped += c.width().unwrap_or(0);
        out
    });
    rest.collect()
}

fn draw_keys(app: &App, pen: &mut Pen, footer: &mut Footer) {
    let (theme, end) = (app.theme(), pen.end());
    pen.put_right(" help", theme.dim()).put_right(&app.keys().name(Action::Help), theme.key());
    footer.actions.push((pen.end()..end, Action::Help));
    pen.put_right("  ", theme.normal());
    let mut told = Vec::new();
    if let Some(hint) = app.hint() {
        let words = hint.words(app);
        if words.iter().map(|word| words::width(word) + 1).sum::<u16>() <= pen.room() {
            draw_words(app, &words, pen);
            pen.put("  ", theme.normal());
            told = words.concat();
        }
    }
    let offered = app.keys().offered(app.focus());
    for (entry, key) in offered.into_iter().filter(|(entry, _)| app.offers(entry.action)) {
        if told.contains(&(words::Tone::Key, key.to_string())) {
            continue;
        }
        let (key, label) = (short(key), label(app, entry));
        if pen.room() < format::width(&key) + 1 + format::width(label) {
            return;
        }
        footer.actions.push((draw_key(app, &key, label, pen), entry.action));
    }
}

/// The columns it stands in.
fn draw_key(app: &App, key: &str, label: &str, pen: &mut Pen) -> Range<u16> {
    let (theme, start) = (app.theme(), pen.at());
    pen.put(key, theme.key()).put(" ", theme.dim()).put(label, theme.dim());
    let columns = start..pen.at();
    pen.put("  ", theme.dim());
    columns
}

/// `Space` is a word among words in the footer; `R` and `r` are different keys.
fn short(key: Key) -> String {
    match &*key.to_string() {
        "Left" => glyphs::LEFT.into(),
        "Right" => glyphs::RIGHT.into(),
        long if long.chars().count() > 1 => long.to_lowercase(),
        single => single.into(),
    }
}

fn label(app: &App, entry: &Entry) -> &'static str {
    let running = app.view().mode == Mode::Running && !app.halted();
    match entry.action {
        Action::Pause if !running => "run",
        _ => entry.label,
    }
}
