//! What is wrong, always in the first rows; below it what happened, newest first, unless a reader holds a place.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::{Title, draw_nothing};
use crate::runtime::record::Level;
use crate::ui::action::Action;
use crate::ui::app::{App, Filter, LogRow, Shown};
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::layout::Pane;
use crate::ui::pen::Pen;
use crate::ui::view::{Cause, Entry, Gravity, Kind, Problem, ProblemKey, name, owner, within};

/// Columns from which on times and words stand with problems, where signs would do.
const WIDE: u16 = 60;
/// The same for all else.
const TIMED: u16 = 31;

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Title {
    let shown = window(app, area);
    if shown.is_empty() {
        draw_nothing(app, area, buffer, &nothing(app));
    }
    let mut y = 0;
    for Shown { row, lines } in &shown {
        let place = Rect { y: area.y + y, height: *lines, ..area }.intersection(area);
        match row {
            LogRow::Problem(key) => {
                let problem = app.view().problems.iter().find(|problem| problem.key == *key);
                problem.into_iter().for_each(|problem| draw_problem(app, problem, place, buffer));
            }
            LogRow::Entry(number) => {
                let entry = app.view().journal.get(*number);
                entry.into_iter().for_each(|entry| draw_entry(app, entry, place, buffer));
            }
        }
        if app.reading().place.as_ref() == Some(row) {
            draw_place(app, place, buffer);
        }
        y += lines;
    }
    Title::new(title(app), note(app))
}

fn window(app: &App, area: Rect) -> Vec<Shown> {
    app.reading().window(app.view(), usize::from(area.height), |key| is_long(app, key, area.width))
}

/// What the line of a row is about.
pub fn at(app: &App, area: Rect, row: usize) -> Option<LogRow> {
    let lines =
        window(app, area).into_iter().flat_map(|shown| std::iter::repeat_n(shown.row, usize::from(shown.lines)));
    lines.into_iter().nth(row)
}

fn nothing(app: &App) -> String {
    let (filter, only) = (app.keys().name(Action::Filter), app.keys().name(Action::OnlyMachine));
    let nothing = match app.reading().filter {
        Filter::Everything => "Nothing happened yet".into(),
        Filter::Transitions => format!("No transitions yet ({filter} shows all)"),
        Filter::WithoutChanges => format!("Nothing but transitions ({filter} shows all)"),
        Filter::Warnings => format!("No warnings or errors ({filter} shows all)"),
        Filter::Errors => format!("No errors ({filter} shows all)"),
    };
    let nothing = match &*app.reading().text {
        "" => nothing,
        text => format!("Nothing says {text} ({} shows all)", app.keys().name(Action::Back)),
    };
    match &app.reading().only {
        Some(machine) => format!("{nothing}, in {} ({only} shows all machines).", name(machine)),
        None => format!("{nothing}."),
    }
}

/// Marks the row a reader is at.
fn draw_place(app: &App, place: Rect, buffer: &mut Buffer) {
    Pen::new(buffer, place, 0).put(glyphs::HERE, app.theme().bold());
    if app.focus() == Pane::Log {
        (0..place.height).for_each(|y| _ = Pen::new(buffer, place, y).wash(app.theme().selected()));
    }
}

/// A problem in one line, and cut into what a first line holds and what is left for a second.
struct Words {
    time: String,
    place: String,
    count: String,
    mark: &'static str,
    whole: String,
    first: String,
    rest: String,
}

impl Words {
    fn of(app: &App, problem: &Problem, columns: u16) -> Words {
        let wide = columns >= WIDE;
        let time = if problem.count > 0 { format::clock(problem.last) } else { String::new() };
        let (file, number) = (&*problem.key.file, problem.key.line);
        let place = line(number);
        let file = if app.view().is_program(file) { "" } else { format::file_name(file) };
        let before: String = [file, name(&problem.state)]
            .iter()
            .filter(|part| !part.is_empty())
            .map(|part| format!("{part}: "))
            .collect();
        let count = if problem.count > 1 { format!(" {}{}", glyphs::TIMES, problem.count) } else { String::new() };
        let mark = if wide { word(problem.gravity) } else { sign(problem.gravity) };
        let taken = 1 + if wide { 8 + format::width(mark) + 2 } else { 2 };
        // A fault that goes on is counted up without its words moving.
        let counted = if problem.count > 0 { format::width(&count).max(5) } else { 0 };
        let room = columns.saturating_sub(taken + counted + 5);
        let mut whole = format!("{before}{}", problem.message);
        let (first, mut rest) = format::split(&whole, room);
        if let Some(help) = &problem.help {
            rest += if rest.is_empty() { "" } else { "; " };
            rest += help;
            whole = format!("{whole}; {help}");
        }
        let time = if wide { format!("{time:>6}  ") } else { String::new() };
        Words { time, place, count, mark, whole, first, rest }
    }
}

/// Whether a problem has more to say than a line of a pane holds.
pub fn is_long(app: &App, key: &ProblemKey, columns: u16) -> bool {
    let problem = app.view().problems.iter().find(|problem| problem.key == *key);
    problem.is_some_and(|problem| !Words::of(app, problem, columns).rest.is_empty())
}

fn draw_problem(app: &App, problem: &Problem, place: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let words = Words::of(app, problem, place.width);
    let mut pen = Pen::new(buffer, place, 0);
    pen.put(" ", theme.normal()).put(&words.time, theme.dim());
    pen.right_column(&words.place, 5, theme.dim()).put_right(&words.count, theme.normal());
    let gap = if words.time.is_empty() { " " } else { "  " };
    pen.put(words.mark, theme.gravity(problem.gravity)).put(gap, theme.normal());
    let indent = pen.at() - place.x;
    match place.height {
        0 | 1 => pen.put(&words.whole, theme.normal()),
        _ => pen.put(&words.first, theme.normal()),
    };
    let mut pen = Pen::new(buffer, place, 1);
    pen.column("", indent, theme.normal()).put(&words.rest, theme.normal());
}

fn draw_entry(app: &App, entry: &Entry, place: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let mut pen = Pen::new(buffer, place, 0);
    pen.put(" ", theme.normal());
    draw_time(app, &format::clock(entry.t), &mut pen);
    match &entry.kind {
        Kind::Log(level) => draw_log(app, entry, *level, place.width, &mut pen),
        Kind::Change(cause) if place.width >= WIDE && app.reading().filter == Filter::Transitions => {
            draw_in_columns(app, entry, cause, &mut pen);
        }
        Kind::Change(_) => draw_change(app, entry, &mut pen),
        Kind::Hand(_) | Kind::Note => _ = pen.put(&entry.text, theme.normal()),
    }
}

/// The line where there is room for it; the transition's name is told in the list of transitions and in the detail.
fn draw_change(app: &App, entry: &Entry, pen: &mut Pen) {
    let theme = app.theme();
    let text = format::width(&entry.text);
    let at = place(app, entry);
    let columns = format::width(&at).max(5);
    if !at.is_empty() && pen.room() >= text + columns {
        pen.right_column(&at, columns, theme.dim());
    }
    pen.put(&entry.text, theme.normal());
}

/// Machine, way, trigger and name below each other, in columns that hold still while the list moves.
fn draw_in_columns(app: &App, entry: &Entry, cause: &Cause, pen: &mut Pen) {
    let (theme, columns) = (app.theme(), Columns::of(app));
    pen.right_column(&place(app, entry), 5, theme.dim());
    let machine = owner(&entry.state).map_or("", name);
    pen.column(machine, columns.machine, theme.dim()).put("  ", theme.dim());
    let way = entry.text.strip_suffix(&*cause.trigger).unwrap_or(&entry.text).trim_end();
    pen.column(way, columns.way, theme.normal()).put("  ", theme.normal());
    pen.put(&cause.trigger, theme.normal());
    if let Some(name) = &cause.name {
        pen.put("  ", theme.dim()).put(name, theme.dim());
    }
}

/// What the longest names need, within reason.
struct Columns {
    machine: u16,
    way: u16,
}

impl Columns {
    fn of(app: &App) -> Columns {
        let only = app.reading().only.as_ref();
        let machines = app.program().map_or(&[][..], |program| &program.machines).iter();
        let machines = machines.filter(|machine| only.is_none_or(|only| within(&machine.path, only)));
        let mut columns = Columns { machine: 0, way: 0 };
        for machine in machines {
            columns.machine = columns.machine.max(format::width(&machine.name)).min(16);
            let names = machine.states.iter().filter_map(|&id| Some(format::width(&app.program()?[id].name)));
            columns.way = columns.way.max(names.max().unwrap_or(0) * 2 + 3).min(32);
        }
        columns
    }
}

fn draw_log(app: &App, entry: &Entry, level: Level, columns: u16, pen: &mut Pen) {
    let theme = app.theme();
    let at = place(app, entry);
    if !at.is_empty() {
        pen.right_column(&at, format::width(&at).max(5), theme.dim());
    }
    if entry.times > 1 {
        pen.put_right(&format!(" {}{}", glyphs::TIMES, entry.times), theme.normal());
    }
    let (word, sign) = level_words(level);
    let text = if level == Level::Debug { theme.dim() } else { theme.normal() };
    let (mark, gap) = if columns < TIMED { (sign, " ") } else { (word, "  ") };
    pen.put(mark, theme.level(level)).put(gap, theme.level(level));
    if !entry.state.is_empty() {
        pen.put(name(&entry.state), text).put(": ", text);
    }
    pen.put(&entry.text, text);
}

/// With room and without.
fn level_words(level: Level) -> (&'static str, &'static str) {
    match level {
        Level::Error => ("error", glyphs::CROSS),
        Level::Warn => ("warn", "!"),
        Level::Info => ("info", glyphs::DOT),
        Level::Debug => ("debug", glyphs::DOT),
    }
}

/// A line as plain text.
pub fn text(app: &App, entry: &Entry) -> String {
    let level = match entry.kind {
        Kind::Log(level) => level_words(level).0,
        _ => "",
    };
    let times = if entry.times > 1 { format!("({} times)", entry.times) } else { String::new() };
    let (clock, at) = (format::clock(entry.t), place(app, entry));
    let words = [&*clock, level, name(&entry.state), &*entry.text, &*times, at.trim_start()];
    words.into_iter().filter(|words| !words.is_empty()).collect::<Vec<_>>().join("  ")
}

/// Left out where the words need the room.
fn draw_time(app: &App, time: &str, pen: &mut Pen) {
    if pen.room() >= TIMED - 1 {
        pen.column_right(time, 6, app.theme().dim()).put("  ", app.theme().dim());
    }
}

fn word(gravity: Gravity) -> &'static str {
    match gravity {
        Gravity::Error => "error",
        Gravity::Warning => "warn",
        Gravity::Hint => "hint",
    }
}

pub(super) fn sign(gravity: Gravity) -> &'static str {
    match gravity {
        Gravity::Error => glyphs::CROSS,
        Gravity::Warning => "!",
        Gravity::Hint => glyphs::DOT,
    }
}

/// Where it was written, ` lib.lrp:24`: with the file where that isn't the program's own.
fn place(app: &App, entry: &Entry) -> String {
    match &entry.place {
        Some((file, number)) if *number > 0 && !app.view().is_program(file) => {
            format!(" {}:{number}", format::file_name(file))
        }
        Some((_, number)) => line(*number),
        None => String::new(),
    }
}

fn line(number: usize) -> String {
    if number > 0 { format!(":{number}") } else { String::new() }
}

fn title(app: &App) -> String {
    let count = |gravity| app.view().problems.iter().filter(|problem| problem.gravity == gravity).count();
    let mut title = String::from(Pane::Log.title());
    for (gravity, noun) in [(Gravity::Error, "error"), (Gravity::Warning, "warning")] {
        match count(gravity) {
            0 => (),
            1 => title += &format!("  1 {noun}"),
            n => title += &format!("  {n} {noun}s"),
        }
    }
    title
}

fn note(app: &App) -> String {
    let reading = app.reading();
    let filter = reading.label();
    if reading.place.is_none() {
        return filter;
    }
    let newer = app.view().journal.newest_first().take_while(|entry| entry.number >= reading.since);
    let newer = newer.filter(|entry| reading.shows(entry)).count();
    let back = app.keys().name(Action::Back);
    let held = if newer > 0 { format!("held, {newer} newer: {back}") } else { format!("held: {back}") };
    if filter.is_empty() { held } else { format!("{filter}, {held}") }
}
