//! From a program's text to a program that can be run, or to what keeps it from being one.

use crate::lua::{Access, Checker};
use crate::model::{Program, Robot, alias, resolve, resolve_renamed};
use crate::syntax::ast::Tree;
use crate::syntax::parser::parse;
use crate::syntax::{Code, Diagnostic, FileId, Source, Span};

pub struct Compiler {
    checker: Checker,
    robots: Vec<Robot>,
}

/// A text that isn't a program; what runs goes on.
pub struct Rejected {
    pub sources: Vec<Source>,
    pub diagnostics: Vec<Diagnostic>,
}

impl Compiler {
    /// `robots`: those chosen on the command line.
    pub fn new(robots: Vec<Robot>) -> Compiler {
        Compiler { checker: Checker::default(), robots }
    }

    /// For blocks that will have this access.
    pub fn with_access(self, access: Access) -> Compiler {
        Compiler { checker: Checker::new(access), ..self }
    }

    /// What keeps the text of a Lua file from being read.
    pub fn check_lua(&mut self, source: &Source) -> Option<Diagnostic> {
        let all = Span::new(FileId(0), 0, source.text.len());
        let error = self.checker.check(&source.text).err()?;
        Some(crate::model::blocks::syntax_diagnostic(source, all, &error))
    }

    pub fn compile(&mut self, source: Source) -> Result<Program, Rejected> {
        self.compile_after(source, &Program::default())
    }

    /// A text that is to follow on a program that runs: names may still mean what they did there.
    pub fn compile_after(&mut self, source: Source, running: &Program) -> Result<Program, Rejected> {
        let parsed = parse(&source, FileId(0));
        let broken = parsed.diagnostics.iter().any(Diagnostic::is_error);
        if parsed.tree.forms.is_empty() && !broken {
            return Err(Rejected { diagnostics: vec![empty(&source)], sources: vec![source] });
        }
        let mut program = self.resolve(&parsed.tree, source, running);
        let is_lua = |finding: &Diagnostic| matches!(finding.code, Code::LuaSyntax | Code::Smalltalk);
        if broken {
            // Forms that can't be read are missing from the tree: what refers to them is not to blame.
            program.findings.retain(is_lua);
        }
        let broken = broken || program.findings.iter().any(is_lua);
        program.findings.splice(0..0, parsed.diagnostics);
        match broken {
            true => Err(Rejected { sources: program.sources, diagnostics: program.findings }),
            false => Ok(program),
        }
    }

    fn resolve(&mut self, tree: &Tree, source: Source, running: &Program) -> Program {
        let program = resolve(tree, source.clone(), &self.robots, &mut self.checker);
        let Some(alias) = alias::propose(running, &program) else { return program };
        let renamed = resolve_renamed(tree, source, &self.robots, &mut self.checker, Some(alias));
        if alias::holds(running, &renamed) { renamed } else { program }
    }
}

fn empty(source: &Source) -> Diagnostic {
    let span = Span::new(FileId(0), 0, source.text.len());
    Diagnostic::error(Code::EmptyProgram, Span { end: span.start, ..span }, "there is no program in this file")
        .help("begin with `(machine m (state s)) (spawn m s)`, or make a first program with `lrp new NAME`")
}
