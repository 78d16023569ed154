//! The simulator's world seen from above, in braille dots of equal width and height; the robot as an arrow.

use std::f64::consts::TAU;

use lrp_sim::{Line, Segment};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;

use super::{Title, draw_nothing};
use crate::ui::app::App;
use crate::ui::format;
use crate::ui::glyphs;
use crate::ui::layout::Pane;
use crate::ui::view::World;

/// Dots of a cell.
const ACROSS: u16 = 2;
const DOWN: u16 = 4;

pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Title {
    let Some(world) = &app.view().world else {
        draw_nothing(app, area, buffer, "No simulated world: `(bridge robot sim)` brings one.");
        return Title::new(Pane::World.title(), "");
    };
    let Some(map) = &world.map else {
        draw_nothing(app, area, buffer, "The world can't be read.");
        return Title::new(format::file_name(&world.name), "");
    };
    let mut dots = Dots::new(area, map.size().width, map.size().height);
    for line in map.lines() {
        dots.line(line);
    }
    for wall in map.walls() {
        dots.segment(*wall, Ink::Wall);
    }
    for &(x, y) in &world.trail {
        dots.dot(x, y, Ink::Trail);
    }
    dots.draw(app, area, buffer);
    draw_robot(app, world, &dots, area, buffer);
    Title::new(format::file_name(&world.name), place(world))
}

fn place(world: &World) -> String {
    let Some(pose) = world.pose else { return String::new() };
    let degrees = pose.theta.to_degrees().rem_euclid(360.0).round() % 360.0;
    format!("{:.2} {:.2} m  {}{}", pose.x, pose.y, format::number(degrees), glyphs::DEGREES)
}

fn draw_robot(app: &App, world: &World, dots: &Dots, area: Rect, buffer: &mut Buffer) {
    let Some(pose) = world.pose else { return };
    let eighth = (pose.theta.rem_euclid(TAU) / TAU * 8.0).round() as usize % 8;
    if let Some((column, row)) = dots.cell(pose.x, pose.y)
        && let Some(cell) = buffer.cell_mut(Position::new(area.x + column, area.y + row))
    {
        cell.set_symbol(glyphs::ARROWS[eighth]).set_style(app.theme().robot());
    }
}

/// What a dot stands for; where several meet in a cell the last has its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Ink {
    Line,
    Wall,
    Trail,
}

/// A grid of dots over a floor, as large as fits, in its middle.
struct Dots {
    columns: u16,
    rows: u16,
    /// Dots a metre.
    scale: f64,
    /// Dots left of and above the floor.
    margin: (f64, f64),
    floor_height: f64,
    cells: Vec<(u8, Option<Ink>)>,
}

impl Dots {
    fn new(area: Rect, width: f64, height: f64) -> Dots {
        let (across, down) = (f64::from(area.width * ACROSS), f64::from(area.height * DOWN));
        let room = |dots: f64, floor: f64| (dots - 1.0).max(0.0) / floor.max(1e-9);
        let scale = room(across, width).min(room(down, height));
        let margin = (((across - 1.0 - width * scale) / 2.0).max(0.0), ((down - 1.0 - height * scale) / 2.0).max(0.0));
        let cells = vec![(0, None); usize::from(area.width) * usize::from(area.height)];
        Dots { columns: area.width, rows: area.height, scale, margin, floor_height: height, cells }
    }

    /// The dot of a place on the floor, x to the right and y up.
    fn at(&self, x: f64, y: f64) -> (f64, f64) {
        (self.margin.0 + x * self.scale, self.margin.1 + (self.floor_height - y) * self.scale)
    }

    fn cell(&self, x: f64, y: f64) -> Option<(u16, u16)> {
        let (across, down) = self.at(x, y);
        if !(across > -0.5 && down > -0.5) {
            return None;
        }
        let (column, row) = (across.round() as u64 / u64::from(ACROSS), down.round() as u64 / u64::from(DOWN));
        let inside = column < u64::from(self.columns) && row < u64::from(self.rows);
        inside.then_some((column as u16, row as u16))
    }

    fn dot(&mut self, x: f64, y: f64, ink: Ink) {
        const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        let Some((column, row)) = self.cell(x, y) else { return };
        let (across, down) = self.at(x, y);
        let bit = BITS[down.round() as usize % usize::from(DOWN)][across.round() as usize % usize::from(ACROSS)];
        let cell = &mut self.cells[usize::from(row) * usize::from(self.columns) + usize::from(column)];
        cell.0 |= bit;
        cell.1 = cell.1.max(Some(ink));
    }

    fn segment(&mut self, segment: Segment, ink: Ink) {
        let (across, up) = (segment.to.x - segment.from.x, segment.to.y - segment.from.y);
        let steps = (across.hypot(up) * self.scale * 2.0).ceil().clamp(1.0, 4000.0) as u32;
        for i in 0..=steps {
            let part = f64::from(i) / f64::from(steps);
            self.dot(segment.from.x + across * part, segment.from.y + up * part, ink);
        }
    }

    /// A painted line as wide as it is.
    fn line(&mut self, line: &Line) {
        let tracks = (line.width * self.scale).floor().clamp(1.0, 40.0) as i32;
        for segment in line.segments() {
            let (across, up) = (segment.to.x - segment.from.x, segment.to.y - segment.from.y);
            let length = across.hypot(up).max(1e-9);
            for track in 0..tracks {
                let aside = (f64::from(track) - f64::from(tracks - 1) / 2.0) / self.scale;
                let (x, y) = (-up / length * aside, across / length * aside);
                let mut shifted = segment;
                shifted.from.x += x;
                shifted.from.y += y;
                shifted.to.x += x;
                shifted.to.y += y;
                self.segment(shifted, Ink::Line);
            }
        }
    }

    fn draw(&self, app: &App, area: Rect, buffer: &mut Buffer) {
        for (i, &(bits, ink)) in self.cells.iter().enumerate() {
            let Some(ink) = ink else { continue };
            let (column, row) = (i % usize::from(self.columns), i / usize::from(self.columns));
            let at = Position::new(area.x + column as u16, area.y + row as u16);
            if let Some(cell) = buffer.cell_mut(at) {
                cell.set_char(glyphs::dots(bits)).set_style(style(app, ink));
            }
        }
    }
}

fn style(app: &App, ink: Ink) -> Style {
    match ink {
        Ink::Line => app.theme().normal(),
        Ink::Wall => app.theme().wall(),
        Ink::Trail => app.theme().trail(),
    }
}
