//! The table of statements a world can have: their words, their numbers, what is allowed. One source for reading and for help.

/// What a statement is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Word {
    Size,
    Ground,
    Start,
    Line,
    From,
    Straight,
    To,
    Left,
    Right,
    Wall,
    Box,
    Light,
    Range,
}

/// One kind of statement.
#[derive(Debug)]
pub(crate) struct Form {
    pub word: Word,
    pub name: &'static str,
    pub fields: &'static [Field],
    pub usage: &'static str,
}

/// One number of a statement.
#[derive(Debug)]
pub(crate) struct Field {
    pub name: &'static str,
    pub least: f64,
    pub most: f64,
    pub default: Option<f64>,
}

/// The largest floor, m a side; no place and no length goes beyond it.
const FAR: f64 = 100.0;

pub(crate) const GROUND: f64 = 230.0;

const fn field(name: &'static str, least: f64, most: f64) -> Field {
    Field { name, least, most, default: None }
}

const fn optional(name: &'static str, least: f64, most: f64, default: f64) -> Field {
    Field { name, least, most, default: Some(default) }
}

const X: Field = field("x", 0.0, FAR);
const Y: Field = field("y", 0.0, FAR);
const HEADING: Field = optional("heading", -360.0, 360.0, 0.0);
const ANGLE: Field = field("angle", 0.1, 360.0);
const RADIUS: Field = field("radius", 0.01, FAR);

pub(crate) const FORMS: &[Form] = &[
    Form {
        word: Word::Size,
        name: "size",
        fields: &[field("width", 0.2, FAR), field("height", 0.2, FAR)],
        usage: "size WIDTH HEIGHT",
    },
    Form { word: Word::Ground, name: "ground", fields: &[field("brightness", 0.0, 255.0)], usage: "ground BRIGHTNESS" },
    Form { word: Word::Start, name: "start", fields: &[X, Y, HEADING], usage: "start X Y heading DEGREES" },
    Form {
        word: Word::Line,
        name: "line",
        fields: &[optional("width", 0.005, 1.0, 0.06), optional("brightness", 0.0, 255.0, 20.0)],
        usage: "line width METRES brightness BRIGHTNESS",
    },
    Form { word: Word::From, name: "from", fields: &[X, Y, HEADING], usage: "from X Y heading DEGREES" },
    Form { word: Word::Straight, name: "straight", fields: &[field("length", 0.001, FAR)], usage: "straight LENGTH" },
    Form { word: Word::To, name: "to", fields: &[X, Y], usage: "to X Y" },
    Form { word: Word::Left, name: "left", fields: &[ANGLE, RADIUS], usage: "left DEGREES radius METRES" },
    Form { word: Word::Right, name: "right", fields: &[ANGLE, RADIUS], usage: "right DEGREES radius METRES" },
    Form {
        word: Word::Wall,
        name: "wall",
        fields: &[field("x1", 0.0, FAR), field("y1", 0.0, FAR), field("x2", 0.0, FAR), field("y2", 0.0, FAR)],
        usage: "wall X1 Y1 X2 Y2",
    },
    Form {
        word: Word::Box,
        name: "box",
        fields: &[X, Y, field("width", 0.001, FAR), field("height", 0.001, FAR)],
        usage: "box X Y WIDTH HEIGHT",
    },
    Form {
        word: Word::Light,
        name: "light",
        fields: &[field("ahead", -0.2, 0.2), optional("left", -0.2, 0.2, 0.0)],
        usage: "light ahead METRES left METRES",
    },
    Form {
        word: Word::Range,
        name: "range",
        fields: &[field("ahead", -0.09, 0.09), optional("left", -0.08, 0.08, 0.0)],
        usage: "range ahead METRES left METRES",
    },
];
