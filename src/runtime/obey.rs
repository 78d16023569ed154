//! Commands to the engine, applied between steps; each is recorded.

use std::rc::Rc;
use std::sync::Arc;

use super::command::Command;
use super::engine::Engine;
use super::machine::Spawner;
use super::record::{Forced, Level, Log, What};
use crate::lua::{Cell, Ran};
use crate::model::names::Names;
use crate::model::{BlockId, StateId, VarId};
use crate::syntax::nearest::nearest;

/// Why a command had no effect, as a sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused(pub String);

impl std::fmt::Display for Refused {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl Engine {
    pub fn command(&mut self, command: Command) -> Result<(), Refused> {
        if !matches!(command, Command::Load(_) | Command::Reject { .. }) {
            self.rare(What::Command { command: command.clone() });
        }
        let result = self.obey(command);
        if let Err(Refused(message)) = &result {
            self.remark(Level::Error, message.clone());
        }
        self.finish();
        self.pause_if_met();
        result
    }

    /// Something to be told that no block wrote.
    pub(super) fn remark(&mut self, level: Level, message: String) {
        let log = Log { level, message, state: Arc::default(), file: Arc::default(), line: 0 };
        self.rare(What::Log(log));
    }

    fn obey(&mut self, command: Command) -> Result<(), Refused> {
        match command {
            Command::Load(edit) if self.holds_saves() => self.hold(edit),
            Command::Load(edit) => self.load(edit),
            Command::ApplyHeld => self.apply_held()?,
            Command::DropHeld => self.drop_held()?,
            Command::OnEdit { mode } => self.on_edit = mode,
            Command::Saves { mode } => self.saves = mode,
            Command::OnError { mode } => self.on_error = mode,
            Command::Explain { mode } => self.why.ask(mode),
            Command::Reject { findings, files } => self.rare(What::Reject { findings, files }),
            Command::Pause => self.pause("asked for", None),
            Command::Runstop => self.pause("runstop", None),
            Command::Resume => self.resume(),
            Command::Restart => self.restart("asked for"),
            Command::TransitionTo { state } => self.force(self.state_called(&state)?, Forced::Transition),
            Command::JumpTo { state } => self.force(self.state_called(&state)?, Forced::Jump),
            Command::Set { var, value } => self.set(&var, &value)?,
            Command::Reset { var } => self.reset(&var)?,
            Command::Tell { bridge, what } => self.tell(&bridge, &what)?,
            Command::Break { at, mode } => self.set_breakpoint(&at, mode)?,
            Command::Step | Command::Rate { .. } | Command::PutAtStart { .. } | Command::FileChanged { .. } => {}
        }
        Ok(())
    }

    pub(super) fn pause(&mut self, reason: &str, at: Option<Arc<str>>) {
        if self.paused {
            return;
        }
        self.paused = true;
        self.rare(What::Pause { reason: reason.to_string(), at });
        if let Some(block) = self.program.on_pause {
            self.run(block);
        }
    }

    fn resume(&mut self) {
        if !self.paused {
            return;
        }
        self.paused = false;
        self.rare(What::Resume);
        if let Some(block) = self.program.on_resume {
            self.run(block);
        }
    }

    /// From scratch, without onexit: the robot is stopped, variables are initialised, spawns done anew. What went wrong
    /// is forgotten, but for what is wrong with the text, and blocks that were stopped have another chance.
    pub(super) fn restart(&mut self, reason: &str) {
        self.rare(What::Restart { reason: reason.to_string() });
        self.rare(What::Stop { reason: "restart".to_string() });
        self.faults.clear();
        self.report_findings();
        self.tops.clear();
        if self.store.any_stopped() {
            (0..self.program.blocks.len() as u32).map(BlockId).for_each(|block| self.store.allow_again(block));
        }
        for index in 0..self.program.vars.len() {
            let cell = self.store.cell(VarId(index as u32));
            self.store.lua.clear(cell);
        }
        self.begin();
    }

    /// Initialises the globals and spawns what is spawned at top level.
    pub(super) fn begin(&mut self) {
        let program = Arc::clone(&self.program);
        let plan = Rc::clone(&self.plan);
        self.running = program.machines.iter().map(|_| None).collect();
        self.visits = vec![0; program.states.len()];
        for &var in &program.globals {
            self.initialise_anew(var);
        }
        for (index, spawn) in program.spawns.iter().enumerate() {
            if let Some((machine, state)) = spawn.target {
                self.spawn(&plan, machine, state, Spawner::Top { index });
            }
        }
        for index in 0..self.tops.len() {
            self.settle(&plan, self.tops[index]);
        }
    }

    pub(super) fn state_called(&self, path: &str) -> Result<StateId, Refused> {
        let known = self.program.states.iter().map(|state| &*state.path);
        self.program.state(path).ok_or_else(|| refuse("state", path, known))
    }

    /// A variable that has a value.
    fn var_called(&self, path: &str) -> Result<VarId, Refused> {
        let program = &self.program;
        let known = program.vars.iter().map(|var| &*var.path);
        let var = program.var(path).ok_or_else(|| refuse("variable", path, known))?;
        match program[var].machine.filter(|_| !self.is_alive(var)) {
            Some(machine) => {
                Err(Refused(format!("`{path}` has no value now: machine `{}` is not running", program[machine].path)))
            }
            None => Ok(var),
        }
    }

    /// What is sent is among the records like anything that a block sends.
    fn tell(&mut self, bridge: &str, what: &str) -> Result<(), Refused> {
        let known = self.program.bridges.iter().map(|bridge| &*bridge.name);
        if !known.clone().any(|name| name == bridge) {
            return Err(refuse("robot", bridge, known));
        }
        let globals: Vec<(&str, Cell)> =
            self.program.globals.iter().map(|&var| (&*self.program[var].name, self.store.cell(var))).collect();
        let code = format!("{bridge}.{what}");
        let wrong = |message: &str| Refused(format!("`{code}`: {message}"));
        let block = self.store.lua.compile(&code, &globals).map_err(|error| wrong(&error.message))?;
        let ran = self.store.lua.run(block);
        self.store.lua.free_block(block);
        match ran {
            Ran::Done => Ok(()),
            Ran::Failed => Err(wrong(&self.store.lua.take_failure().message)),
        }
    }

    fn reset(&mut self, path: &str) -> Result<(), Refused> {
        let var = self.var_called(path)?;
        self.initialise_anew(var);
        Ok(())
    }

    fn set(&mut self, path: &str, value: &str) -> Result<(), Refused> {
        let var = self.var_called(path)?;
        let program = Arc::clone(&self.program);
        let in_scope = Names::of(&program).vars_in_scope(program[var].machine);
        let scope: Vec<(&str, Cell)> =
            in_scope.iter().map(|&var| (&*program[var].name, self.store.cell(var))).collect();
        let block =
            self.store.lua.compile(value, &scope).map_err(|error| Refused(format!("`{value}`: {}", error.message)))?;
        let done = match self.store.lua.init(block, self.store.cell(var)) {
            Ran::Done => Ok(()),
            Ran::Failed => Err(Refused(format!("`{value}`: {}", self.store.lua.take_failure().message))),
        };
        self.store.lua.free_block(block);
        done?;
        self.store.lua.changed(self.store.cell(var));
        self.report(var, "command".into());
        Ok(())
    }
}

pub(super) fn refuse<'a>(what: &str, path: &str, known: impl Iterator<Item = &'a str>) -> Refused {
    let near = nearest(path, known).map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
    Refused(format!("there is no {what} `{path}`{near}"))
}
