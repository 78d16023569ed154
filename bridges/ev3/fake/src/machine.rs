//! What a brick does with the operations of a direct command, written from the facts known of bricks and not from the
//! bridge: motors that turn, sensors with modes, and opcodes that block.

use std::time::{Duration, Instant};

/// Degrees a second at full speed.
const FULL_SPEED: f64 = 1000.0;

/// How long a sensor gives nothing after a change of mode.
const CHANGE: Duration = Duration::from_millis(40);

const NO_BYTE: u8 = 0x80;
const NO_INTEGER: [u8; 4] = [0, 0, 0, 0x80];

pub struct Machine {
    pub motors: [Motor; 4],
    pub sensors: [Sensor; 4],
    /// Numbers of the buttons that are down.
    pub pressed: Vec<i32>,
    /// Calls for lights and sounds, in words.
    pub shown: Vec<String>,
    /// Opcodes that had the brick wait.
    pub blocked: usize,
    pub kept_awake: usize,
    last: Instant,
}

#[derive(Clone, Copy)]
pub struct Motor {
    pub kind: u8,
    pub position: f64,
    /// Per cent.
    pub speed: f64,
    pub regulated: bool,
    /// How far it turns still, degrees or ms.
    left: Option<Left>,
    pub brake: bool,
}

#[derive(Clone, Copy)]
enum Left {
    Degrees(f64),
    Milliseconds(f64),
}

#[derive(Clone)]
pub struct Sensor {
    pub kind: u8,
    pub mode: u8,
    pub values: Vec<f32>,
    pub raw: i32,
    pub percent: u8,
    since: Instant,
}

/// An opcode or a parameter that makes no sense: the brick answers with an error.
pub struct Nonsense;

impl Default for Machine {
    fn default() -> Machine {
        let motor = Motor { kind: 7, position: 0.0, speed: 0.0, regulated: false, left: None, brake: false };
        let sensor = Sensor { kind: 0x7e, mode: 0, values: vec![], raw: 0, percent: 0, since: Instant::now() - CHANGE };
        Machine {
            motors: [motor; 4],
            sensors: std::array::from_fn(|_| sensor.clone()),
            pressed: Vec::new(),
            shown: Vec::new(),
            blocked: 0,
            kept_awake: 0,
            last: Instant::now(),
        }
    }
}

impl Machine {
    pub fn plug(&mut self, port: usize, kind: u8, values: &[f32]) {
        let sensor = &mut self.sensors[port - 1];
        (sensor.kind, sensor.mode, sensor.values) = (kind, 0, values.to_vec());
    }

    pub fn pass(&mut self) {
        let now = Instant::now();
        let passed = now.duration_since(self.last).as_secs_f64();
        self.last = now;
        self.motors.iter_mut().for_each(|motor| motor.pass(passed));
    }

    /// Runs operations; what they answer goes into the globals. Some keep the brick for a while: that long is returned,
    /// and nobody may be heard meanwhile.
    pub fn run(&mut self, ops: &[u8], globals: &mut [u8]) -> Result<Duration, Nonsense> {
        self.pass();
        let mut run = Run { ops, globals };
        let mut waits = Duration::ZERO;
        while !run.ops.is_empty() {
            waits += self.operation(&mut run)?;
        }
        Ok(waits)
    }

    fn operation(&mut self, run: &mut Run) -> Result<Duration, Nonsense> {
        let code = run.opcode()?;
        match code {
            0xa2 | 0xb2 => self.each(run, |motor, _| motor.position = 0.0, 0)?,
            0xa3 => self.each(run, |motor, given| motor.halt(given[0] != 0), 1)?,
            0xa4 => self.each(run, |motor, given| (motor.speed, motor.regulated) = (given[0].into(), false), 1)?,
            0xa5 => self.each(run, |motor, given| (motor.speed, motor.regulated) = (given[0].into(), true), 1)?,
            0xa6 => self.each(run, |motor, _| motor.left = None, 0)?,
            0xac | 0xae => self.each(run, |motor, given| motor.turn(given, Left::Degrees), 5)?,
            0xad | 0xaf => self.each(run, |motor, given| motor.turn(given, Left::Milliseconds), 5)?,
            0xb0 | 0xb1 => self.together(run, code)?,
            0xa8 => {
                let motor = self.motor(run)?;
                run.answer(&[motor.speed as i8 as u8])?;
                run.answer(&(motor.position as i32).to_le_bytes())?;
            }
            0xa9 => {
                let [_, motors] = run.numbers()?;
                let busy = (0..4).any(|index| motors & 1 << index != 0 && self.motors[index].left.is_some());
                run.answer(&[busy.into()])?;
            }
            0xaa => {
                let [_, motors] = run.numbers()?;
                self.blocked += 1;
                let longest =
                    (0..4).filter(|index| motors & 1 << index != 0).map(|index| self.motors[index].time_left());
                return Ok(longest.max().unwrap_or_default());
            }
            0xb3 => {
                let motor = self.motor(run)?;
                run.answer(&(motor.position as i32).to_le_bytes())?;
            }
            0x99 => return self.device(run),
            0x9a => {
                let sensor = self.sensor(run)?;
                run.answer(&[if sensor.is_ready() { sensor.percent } else { NO_BYTE }])?;
            }
            0x9d => {
                let sensor = self.sensor(run)?;
                run.answer(&sensor.value(0).to_le_bytes())?;
            }
            0x9e => self.several(run)?,
            0x90 => {
                self.kept_awake += 1;
                run.answer(&[30])?;
            }
            0x81 => match run.opcode()? {
                0x01 => run.answer(&7.4f32.to_le_bytes())?,
                0x02 => run.answer(&0.1799f32.to_le_bytes())?,
                0x12 => run.answer(&[83])?,
                _ => return Err(Nonsense),
            },
            0x83 => {
                let (0x09, [button]) = (run.opcode()?, run.numbers()?) else { return Err(Nonsense) };
                run.answer(&[self.pressed.contains(&button).into()])?;
            }
            0x82 => {
                let (0x1b, [light]) = (run.opcode()?, run.numbers()?) else { return Err(Nonsense) };
                self.shown.push(format!("light {light}"));
            }
            0x94 => self.sound(run)?,
            _ => return Err(Nonsense),
        }
        Ok(Duration::ZERO)
    }

    fn each(&mut self, run: &mut Run, mut act: impl FnMut(&mut Motor, &[i32]), more: usize) -> Result<(), Nonsense> {
        let [_, motors] = run.numbers()?;
        let given = (0..more).map(|_| run.number()).collect::<Result<Vec<_>, _>>()?;
        let chosen = (0..4).filter(|index| motors & 1 << index != 0);
        chosen.for_each(|index| act(&mut self.motors[index], &given));
        Ok(())
    }

    /// Two motors that are done at the same time, one of them slower.
    fn together(&mut self, run: &mut Run, code: u8) -> Result<(), Nonsense> {
        let [_, motors, speed, turn, way, brake] = run.numbers()?;
        let ms = match code {
            0xb0 => (f64::from(way) / (f64::from(speed.abs()) / 100.0 * FULL_SPEED) * 1000.0) as i32,
            _ => way,
        };
        let slower = speed - speed * turn.abs() / 100;
        let chosen = (0..4).filter(|index| motors & 1 << index != 0);
        for (index, speed) in chosen.zip(if turn > 0 { [speed, slower] } else { [slower, speed] }) {
            self.motors[index].turn(&[speed, ms, 0, 0, brake], Left::Milliseconds);
        }
        Ok(())
    }

    fn motor(&self, run: &mut Run) -> Result<Motor, Nonsense> {
        let [_, index] = run.numbers()?;
        self.motors.get(index as usize).copied().ok_or(Nonsense)
    }

    fn device(&mut self, run: &mut Run) -> Result<Duration, Nonsense> {
        match run.opcode()? {
            0x05 => {
                let [_, port] = run.numbers()?;
                let (kind, mode) = match port {
                    0..=3 => (self.sensors[port as usize].kind, self.sensors[port as usize].mode),
                    16..=19 => (self.motors[port as usize - 16].kind, 0),
                    _ => (0x7e, 0),
                };
                run.answer(&[kind])?;
                run.answer(&[mode])?;
            }
            0x0d => {
                run.numbers::<1>()?;
                self.motors.iter_mut().for_each(|motor| motor.halt(true));
            }
            // They wait until the sensor is ready.
            0x1b..=0x1d => {
                self.blocked += 1;
                return Ok(CHANGE);
            }
            _ => return Err(Nonsense),
        }
        Ok(Duration::ZERO)
    }

    /// The sensor of a reading, put into the mode that is asked for with it.
    fn sensor(&mut self, run: &mut Run) -> Result<&Sensor, Nonsense> {
        let [_, port, _, mode] = run.numbers()?;
        let sensor = self.sensors.get_mut(port as usize).ok_or(Nonsense)?;
        if sensor.is_ready() && mode >= 0 && mode != i32::from(sensor.mode) {
            (sensor.mode, sensor.since) = (mode as u8, Instant::now());
        }
        Ok(sensor)
    }

    fn several(&mut self, run: &mut Run) -> Result<(), Nonsense> {
        let sensor = self.sensor(run)?.clone();
        let [format, count] = run.numbers()?;
        for index in 0..count as usize {
            match format {
                0x10 => run.answer(&[if sensor.is_ready() { sensor.percent } else { NO_BYTE }])?,
                0x12 => run.answer(&if sensor.is_ready() { sensor.raw.to_le_bytes() } else { NO_INTEGER })?,
                0x13 => run.answer(&sensor.value(index).to_le_bytes())?,
                _ => return Err(Nonsense),
            }
        }
        Ok(())
    }

    fn sound(&mut self, run: &mut Run) -> Result<(), Nonsense> {
        let sound = match run.opcode()? {
            0x00 => "silence".to_string(),
            0x01 => format!("tone {:?}", run.numbers::<3>()?),
            0x02 => format!("play {} {}", run.number()?, run.text()?),
            _ => return Err(Nonsense),
        };
        self.shown.push(sound);
        Ok(())
    }
}

impl Motor {
    pub fn is_turning(&self) -> bool {
        self.speed != 0.0
    }

    fn halt(&mut self, brake: bool) {
        (self.speed, self.left, self.brake) = (0.0, None, brake);
    }

    fn turn(&mut self, given: &[i32], left: fn(f64) -> Left) {
        let &[speed, first, second, third, brake] = given else { return };
        let way: f64 = [first, second, third].map(f64::from).iter().sum();
        self.speed = speed.into();
        // A way of no length has no end.
        self.left = (way > 0.0).then(|| left(way));
        self.brake = brake != 0;
    }

    fn pass(&mut self, seconds: f64) {
        let seconds = match self.left {
            None => seconds,
            Some(_) => seconds.min(self.time_left().as_secs_f64()),
        };
        let turned = self.speed / 100.0 * FULL_SPEED * seconds;
        self.position += turned;
        self.left = match self.left {
            Some(Left::Degrees(degrees)) => Some(Left::Degrees(degrees - turned.abs())),
            Some(Left::Milliseconds(ms)) => Some(Left::Milliseconds(ms - seconds * 1000.0)),
            None => None,
        };
        if let Some(Left::Degrees(left) | Left::Milliseconds(left)) = self.left
            && left < 1e-6
        {
            self.position = self.position.round();
            self.halt(self.brake);
        }
    }

    fn time_left(&self) -> Duration {
        Duration::from_secs_f64(match self.left {
            Some(Left::Degrees(degrees)) if self.speed != 0.0 => degrees / (self.speed.abs() / 100.0 * FULL_SPEED),
            Some(Left::Milliseconds(ms)) => ms.max(0.0) / 1000.0,
            _ => 0.0,
        })
    }
}

impl Sensor {
    fn is_ready(&self) -> bool {
        self.kind < 0x7d && self.since.elapsed() >= CHANGE
    }

    fn value(&self, index: usize) -> f32 {
        self.values.get(index).copied().filter(|_| self.is_ready()).unwrap_or(f32::NAN)
    }
}

/// Operations being read.
struct Run<'a> {
    ops: &'a [u8],
    globals: &'a mut [u8],
}

enum Parameter {
    Number(i32),
    Global(usize),
}

impl Run<'_> {
    fn opcode(&mut self) -> Result<u8, Nonsense> {
        let (&first, rest) = self.ops.split_first().ok_or(Nonsense)?;
        self.ops = rest;
        Ok(first)
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], Nonsense> {
        let (&bytes, rest) = self.ops.split_first_chunk().ok_or(Nonsense)?;
        self.ops = rest;
        Ok(bytes)
    }

    fn parameter(&mut self) -> Result<Parameter, Nonsense> {
        Ok(match self.opcode()? {
            short @ 0x00..=0x1f => Parameter::Number(short.into()),
            short @ 0x20..=0x3f => Parameter::Number(i32::from(short) - 64),
            short @ 0x60..=0x7f => Parameter::Global((short & 0x1f).into()),
            0x81 => Parameter::Number((self.bytes::<1>()?[0] as i8).into()),
            0x82 => Parameter::Number(i16::from_le_bytes(self.bytes()?).into()),
            0x83 => Parameter::Number(i32::from_le_bytes(self.bytes()?)),
            0xe1 => Parameter::Global(self.bytes::<1>()?[0].into()),
            0xe2 => Parameter::Global(u16::from_le_bytes(self.bytes()?).into()),
            _ => return Err(Nonsense),
        })
    }

    fn number(&mut self) -> Result<i32, Nonsense> {
        match self.parameter()? {
            Parameter::Number(number) => Ok(number),
            Parameter::Global(_) => Err(Nonsense),
        }
    }

    fn numbers<const N: usize>(&mut self) -> Result<[i32; N], Nonsense> {
        let mut numbers = [0; N];
        for number in &mut numbers {
            *number = self.number()?;
        }
        Ok(numbers)
    }

    fn text(&mut self) -> Result<String, Nonsense> {
        let end = self.ops.iter().position(|&byte| byte == 0).ok_or(Nonsense)?;
        let (0x84, text) = (self.ops[0], String::from_utf8_lossy(&self.ops[1..end]).into_owned()) else {
            return Err(Nonsense);
        };
        self.ops = &self.ops[end + 1..];
        Ok(text)
    }

    fn answer(&mut self, bytes: &[u8]) -> Result<(), Nonsense> {
        let Parameter::Global(at) = self.parameter()? else { return Err(Nonsense) };
        // A processor of its kind can't reach numbers that lie across.
        if at % bytes.len() != 0 {
            return Err(Nonsense);
        }
        self.globals.get_mut(at..at + bytes.len()).ok_or(Nonsense)?.copy_from_slice(bytes);
        Ok(())
    }
}
