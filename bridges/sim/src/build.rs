//! Puts a world together from its statements and checks what they mean together. Knows nothing of the text's layout.

use crate::drawing::Lines;
use crate::fault::{Fault, Place};
use crate::form::{GROUND, Word};
use crate::geometry::{Point, Pose, Segment, wrapped};
use crate::reader::{Number, Statement, read};
use crate::robot;
use crate::world::{Block, Mount, Size, World};

const MOST_FAULTS: usize = 50;
const MOST_TEXT: usize = 1_000_000;
const MOST_WALLS: usize = 1_000;
/// How far rounding may put a box or the end of a line off the floor, m.
pub(crate) const SLACK: f64 = 1e-6;

const SMALLEST_WORLD: &str = "the smallest world is two lines: `size 2 1` and `start 0.5 0.5 heading 0`";

pub(crate) fn world(text: &str) -> Result<World, Vec<Fault>> {
    let top = Place { line: 1, column: 1 };
    if text.len() > MOST_TEXT {
        return Err(vec![top.fault("the text is too long for a world").with_help("at most 1 MB")]);
    }
    let (statements, faults) = read(text);
    if statements.is_empty() && faults.is_empty() {
        return Err(vec![top.fault("the world is empty").with_help(SMALLEST_WORLD)]);
    }
    let mut builder = Builder::new(size(&statements), faults);
    for statement in &statements {
        builder.take(statement);
    }
    builder.finish(top)
}

fn size(statements: &[Statement]) -> Option<Size> {
    let numbers = &statements.iter().find(|statement| statement.word == Word::Size)?.numbers;
    Some(Size { width: numbers[0].value, height: numbers[1].value })
}

struct Builder {
    size: Option<Size>,
    start: Option<(Pose, Place)>,
    ground: f64,
    light: Mount,
    range: Mount,
    lines: Lines,
    walls: Vec<Segment>,
    boxes: Vec<Block>,
    seen: Vec<(Word, Place)>,
    faults: Vec<Fault>,
}

impl Builder {
    fn new(size: Option<Size>, faults: Vec<Fault>) -> Builder {
        Builder {
            size,
            start: None,
            ground: GROUND,
            light: Mount { ahead: robot::LIGHT_AHEAD, left: 0.0 },
            range: Mount { ahead: robot::RANGE_AHEAD, left: 0.0 },
            lines: Lines::on(size),
            walls: size.map(edges).unwrap_or_default(),
            boxes: Vec::new(),
            seen: Vec::new(),
            faults,
        }
    }

    fn take(&mut self, statement: &Statement) {
        let n = &statement.numbers;
        match statement.word {
            Word::Size => self.once(statement),
            Word::Ground => {
                self.once(statement);
                self.ground = n[0].value;
            }
            Word::Start => {
                self.once(statement);
                let place = self.on_floor(n[0], n[1]);
                self.start = Some((pose(place, n[2]), statement.place));
            }
            Word::Light => {
                self.once(statement);
                self.light = mount(n);
            }
            Word::Range => {
                self.once(statement);
                self.range = mount(n);
            }
            Word::Wall => self.wall(statement),
            Word::Box => self.block(statement),
            Word::Line => self.lines.begin(statement, &mut self.faults),
            Word::From => {
                let place = self.on_floor(n[0], n[1]);
                self.lines.put_pen(statement, place, &mut self.faults);
            }
            Word::Straight | Word::To | Word::Left | Word::Right => self.lines.draw(statement, &mut self.faults),
        }
    }

    /// Notes a fault when a statement that may stand once stands again.
    fn once(&mut self, statement: &Statement) {
        match self.seen.iter().find(|(word, _)| *word == statement.word) {
            Some((_, first)) => {
                let message = format!("`{}` was given already, on line {}", statement.name, first.line);
                self.faults.push(statement.place.fault(message).with_help("keep one of them"));
            }
            None => self.seen.push((statement.word, statement.place)),
        }
    }

    /// The point of two coordinates; a fault for each that is off the floor.
    fn on_floor(&mut self, x: Number, y: Number) -> Point {
        if let Some(size) = self.size {
            for (number, name, most) in [(x, "x", size.width), (y, "y", size.height)] {
                if number.value > most {
                    let message = format!("{name} = {} is off the floor", number.value);
                    self.faults.push(number.place.fault(message).with_help(format!("{name} goes from 0 to {most}")));
                }
            }
        }
        Point::new(x.value, y.value)
    }

    fn wall(&mut self, statement: &Statement) {
        let n = &statement.numbers;
        let wall = Segment { from: self.on_floor(n[0], n[1]), to: self.on_floor(n[2], n[3]) };
        if wall.length() < 0.001 {
            self.faults.push(statement.place.fault("the wall has no length").with_help("its two ends are the same"));
        }
        self.add_walls(statement, &[wall]);
    }

    fn block(&mut self, statement: &Statement) {
        let n = &statement.numbers;
        let low = self.on_floor(n[0], n[1]);
        let high = low + Point::new(n[2].value, n[3].value);
        if let Some(size) = self.size
            && (high.x > size.width + SLACK || high.y > size.height + SLACK)
        {
            let message = format!("the box reaches to {} {}, off the floor", high.x, high.y);
            let help = format!("x goes from 0 to {}, y from 0 to {}", size.width, size.height);
            self.faults.push(statement.place.fault(message).with_help(help));
        }
        self.add_walls(statement, &sides(low, high));
        self.boxes.push(Block { low, high });
    }

    fn add_walls(&mut self, statement: &Statement, walls: &[Segment]) {
        if self.walls.len() <= MOST_WALLS {
            self.walls.extend(walls);
            if self.walls.len() > MOST_WALLS {
                let fault = statement.place.fault("too many walls");
                self.faults
                    .push(fault.with_help(format!("at most {MOST_WALLS}; a box has four, and so has the floor")));
            }
        }
    }

    fn finish(mut self, top: Place) -> Result<World, Vec<Fault>> {
        self.lines.end(&mut self.faults);
        self.require_basics(top);
        let (Some(size), Some((start, place)), true) = (self.size, self.start, self.faults.is_empty()) else {
            self.faults.sort_by_key(|fault| (fault.line, fault.column));
            self.faults.truncate(MOST_FAULTS);
            return Err(self.faults);
        };
        let world = World {
            size,
            start,
            ground: self.ground,
            lines: self.lines.into_drawn(),
            walls: self.walls,
            boxes: self.boxes,
            light: self.light,
            range: self.range,
        };
        if world.has_room_at(start.place()) {
            return Ok(world);
        }
        let help = format!("its body is a disc of {} m radius; move the start or the wall", robot::RADIUS);
        Err(vec![place.fault("the robot would start in a wall").with_help(help)])
    }

    /// Notes a fault when there is no floor or no start; not when the text tried to give one and failed.
    fn require_basics(&mut self, top: Place) {
        let tried = !self.faults.is_empty();
        if self.size.is_none() && !tried {
            self.faults.push(top.fault("the world has no size").with_help("add a line `size WIDTH HEIGHT`, in metres"));
        }
        if self.start.is_none() && !tried {
            self.faults
                .push(top.fault("the robot has no place to start").with_help("add a line `start X Y heading DEGREES`"));
        }
    }
}

fn pose(place: Point, heading: Number) -> Pose {
    Pose { x: place.x, y: place.y, theta: wrapped(heading.value.to_radians()) }
}

fn mount(numbers: &[Number]) -> Mount {
    Mount { ahead: numbers[0].value, left: numbers[1].value }
}

fn edges(size: Size) -> Vec<Segment> {
    sides(Point::new(0.0, 0.0), Point::new(size.width, size.height)).to_vec()
}

fn sides(low: Point, high: Point) -> [Segment; 4] {
    let corners = [low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)];
    [0, 1, 2, 3].map(|side| Segment { from: corners[side], to: corners[(side + 1) % 4] })
}
