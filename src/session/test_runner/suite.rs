//! The tests of one file: gathered by running it, then run one after the other, each with a program of its own.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::{Duration, Instant};

use mlua::{Function, MultiValue, Value};

use super::api::Api;
use super::deadline::Deadline;
use super::failure::{Complaint, Failure};
use super::functions;
use super::lua::TestLua;
use super::report::Outcome;
use crate::session::live::folder;
use crate::session::loader;

struct Test {
    name: String,
    body: Function,
}

struct Suite {
    file: PathBuf,
    lua: TestLua,
    deadline: Deadline,
    tests: Rc<RefCell<Vec<Test>>>,
    printed: Rc<RefCell<Vec<String>>>,
}

pub fn run(file: &Path, limit: Duration, mut on: impl FnMut(&Outcome)) -> Vec<Outcome> {
    let started = Instant::now();
    let suite = match Suite::read(file, limit) {
        Ok(suite) => suite,
        Err(failure) => {
            let took = started.elapsed();
            let outcome =
                Outcome { file: file.to_path_buf(), name: None, took, printed: Vec::new(), failure: Some(failure) };
            on(&outcome);
            return vec![outcome];
        }
    };
    let tests = suite.tests.take();
    let outcomes = tests.into_iter().map(|test| {
        let outcome = suite.outcome(test);
        on(&outcome);
        outcome
    });
    outcomes.collect()
}

impl Suite {
    fn read(file: &Path, limit: Duration) -> Result<Suite, Failure> {
        let source = loader::read(file).map_err(|why| told(why.to_string()))?;
        let deadline = Deadline::new(limit);
        let lua = TestLua::new(&folder(file), deadline.clone()).map_err(|error| told(error.to_string()))?;
        let suite = Suite { file: file.to_path_buf(), lua, deadline, tests: Rc::default(), printed: Rc::default() };
        suite.offer().map_err(|error| told(error.to_string()))?;
        let chunk = suite.lua.chunk(file, &source.text).map_err(|failure| suite.quoting(failure))?;
        suite.lua.call(chunk, ()).map_err(|failure| suite.quoting(failure))?;
        match suite.tests.borrow().is_empty() {
            true => Err(told(format!(
                "{}: there are no tests in it; write `test(NAME, function(t) .. end)`",
                file.display()
            ))),
            false => Ok(()),
        }?;
        Ok(suite)
    }

    /// `test` and `print`.
    fn offer(&self) -> mlua::Result<()> {
        let (lua, tests, printed) = (&self.lua.lua, Rc::clone(&self.tests), Rc::clone(&self.printed));
        let test = lua.create_function(move |_, (name, body): (Value, Value)| match (name, body) {
            (Value::String(name), Value::Function(body)) => {
                tests.borrow_mut().push(Test { name: name.to_string_lossy(), body });
                Ok(())
            }
            _ => Err(Complaint::new("a test is written `test(NAME, function(t) .. end)`").into()),
        })?;
        let print = lua.create_function(move |_, values: MultiValue| {
            let texts: Vec<String> = values.iter().map(Value::to_string).collect::<mlua::Result<_>>()?;
            printed.borrow_mut().push(texts.join("\t"));
            Ok(())
        })?;
        lua.globals().raw_set("test", test)?;
        lua.globals().raw_set("print", print)
    }

    fn outcome(&self, Test { name, body }: Test) -> Outcome {
        let started = Instant::now();
        let failure = self.run(body).err();
        let printed = self.printed.take();
        Outcome { file: self.file.clone(), name: Some(name), took: started.elapsed(), printed, failure }
    }

    fn run(&self, body: Function) -> Result<(), Failure> {
        let api = Rc::new(Api::new(&folder(&self.file), self.deadline.clone()));
        let t = functions::table(&self.lua.lua, &api).map_err(|error| told(error.to_string()))?;
        let failed = self.lua.call(body, t);
        // A test in a test would never be run.
        let nested = self.tests.take().pop();
        let nested = nested.map(|test| told(format!("the test `{}` is written inside another one", test.name)));
        failed.and(nested.map_or(Ok(()), Err)).map_err(|failure| {
            let situation = api.look(|bench| bench.situation());
            Failure { situation, ..self.quoting(failure) }
        })
    }

    /// With the line that failed, as it is written.
    fn quoting(&self, failure: Failure) -> Failure {
        let place = failure.places.first();
        let text = place.and_then(|place| Some((loader::read(&place.file).ok()?, place.line)));
        let line = text.map(|(source, line)| source.text[source.line_range(line)].to_string());
        Failure { line, ..failure }
    }
}

/// A failure that has no line.
fn told(message: String) -> Failure {
    Failure { places: Vec::new(), line: None, complaint: Complaint::new(message), situation: None }
}
