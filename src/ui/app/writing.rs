//! Writing values that were set by hand into the program's text as initial values, and what is said of those that aren't.

use serde_json::Value;

use super::{App, Effect};
use crate::model::initial::{Unwritable, with_initials};
use crate::model::{Program, VarId};
use crate::session::write_back::{NotWritten, Rewrite};
use crate::syntax::FileId;
use crate::ui::format;
use crate::ui::view::{Path, name};

/// A file's new text, and the values that it has from the screen.
#[derive(Clone, Debug, PartialEq)]
pub struct WriteBack {
    pub rewrite: Rewrite,
    pub values: Vec<(Path, Value)>,
    /// What it has for a robot's form.
    pub setting: Option<String>,
}

impl App {
    /// What was set by hand and no file has.
    pub fn unwritten(&self) -> impl Iterator<Item = (&Path, &Value)> {
        self.view.unwritten().filter(|&(path, value)| self.written.get(path) != Some(value))
    }

    /// The same of one variable.
    pub fn unwritten_value(&self, path: &Path) -> Option<&Value> {
        let value = self.view.by_hand.get(path)?;
        (self.view.is_unwritten(path, value) && self.written.get(path) != Some(value)).then_some(value)
    }

    pub(super) fn write_selected(&mut self) -> Vec<Effect> {
        let Some(path) = self.selected_variable() else { return Vec::new() };
        let Some(var) = self.program().and_then(|program| program.var(&path)) else {
            return self.say(format!("{path} comes from the robot and has no place in the text"));
        };
        let on_its_way = self.nudged.as_ref().filter(|(nudged, _)| *nudged == path).map(|(_, value)| value);
        let present = || self.view.variables.get(&path).and_then(|variable| variable.value.as_ref());
        match on_its_way.or_else(|| self.view.by_hand.get(&path)).or_else(present).cloned() {
            Some(value) => self.write(vec![(var, value)]),
            None => self.say(format!("{path} has no value: its machine isn't running")),
        }
    }

    pub(super) fn write_all(&mut self) -> Vec<Effect> {
        let Some(program) = self.program() else { return Vec::new() };
        let all = self.unwritten().filter_map(|(path, value)| Some((program.var(path)?, value.clone())));
        let all: Vec<(VarId, Value)> = all.collect();
        self.write(all)
    }

    fn write(&mut self, values: Vec<(VarId, Value)>) -> Vec<Effect> {
        let Some(program) = self.view.program.clone() else { return Vec::new() };
        let (texts, refused) = with_initials(&program, &values);
        let told = |(var, why): &(VarId, Unwritable)| format!("{} {why}", program[*var].path);
        self.refused = refused.iter().map(told).collect::<Vec<_>>().join("; ");
        let is_refused = |var: VarId| refused.iter().any(|(refused, _)| *refused == var);
        let write_back = |(file, to): (FileId, String)| {
            let here = values.iter().filter(|(var, _)| file_of(&program, *var) == file && !is_refused(*var));
            let values = here.map(|(var, value)| (program[*var].path.clone(), value.clone())).collect();
            let source = &program.sources[usize::from(file.0)];
            WriteBack {
                rewrite: Rewrite { file: source.name.clone(), from: source.text.clone(), to },
                values,
                setting: None,
            }
        };
        let all: Vec<WriteBack> = texts.into_iter().map(write_back).collect();
        match all.is_empty() {
            true => self.say(self.refused.clone()),
            false => vec![Effect::WriteBack(all)],
        }
    }

    /// What became of an `Effect::WriteBack`.
    pub fn written(&mut self, all: Vec<(WriteBack, Result<(), NotWritten>)>) {
        let mut told = Vec::new();
        for (WriteBack { rewrite, values, setting }, result) in all {
            match result {
                Ok(()) => {
                    let named = values.iter().map(|(path, value)| format!("{} {}", name(path), format::exactly(value)));
                    let named = named.chain(setting).collect::<Vec<_>>().join(", ");
                    told.push(format!("written to {}: {named}", format::file_name(&rewrite.file)));
                    self.written.extend(values);
                    self.tour.iter_mut().for_each(|tour| tour.written(&self.view));
                }
                Err(why) => told.insert(0, why.to_string()),
            }
        }
        told.extend(Some(std::mem::take(&mut self.refused)).filter(|refused| !refused.is_empty()));
        self.notice(told.join("; "));
    }

    /// For those who read what is left when the screen is gone: one line for each value that no file has.
    pub fn farewell(&self) -> Vec<String> {
        let Some(program) = self.program() else { return Vec::new() };
        let line = |(path, value): (&Path, &Value)| {
            let var = &program[program.var(path)?];
            let source = program.source(var.name_span);
            let (file, line) = (&source.name, source.line(var.name_span.start as usize));
            let code = program[var.init].code.trim();
            let begins = format::fit(code, 30);
            Some(format!(
                "{file}:{line}: {path} was set to {} by hand; the file still has {begins}",
                format::exactly(value)
            ))
        };
        self.unwritten().filter_map(line).collect()
    }
}

fn file_of(program: &Program, var: VarId) -> FileId {
    program[program[var].init].span.file
}
