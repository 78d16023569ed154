//! Reads a program with all files it imports, each once. What they mean is for the model to say.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::files::{Files, plain, relative};
use super::live::folder;
use super::loader::Unreadable;
use super::watch::Watched;
use crate::model::{File, files};
use crate::syntax::ast::{self, Form};
use crate::syntax::{Code, Diagnostic, FileId, Parsed, Source, parse};

/// A file of the program as it was read.
#[derive(Clone)]
pub struct Gathered {
    pub source: Source,
    pub parsed: Rc<Parsed>,
    pub imports: Vec<Option<FileId>>,
    pub qualifier: String,
}

impl Gathered {
    pub fn file(&self) -> File<'_> {
        File {
            source: self.source.clone(),
            tree: &self.parsed.tree,
            imports: self.imports.clone(),
            qualifier: self.qualifier.clone(),
        }
    }
}

/// The imports of a file that are still to be followed.
struct Imports {
    by: FileId,
    left: std::vec::IntoIter<ast::Name>,
}

pub struct Gathering<'a> {
    files: &'a dyn Files,
    /// What was read the last time, by `FileId`: an unchanged text is not parsed again.
    before: &'a [Gathered],
    /// The folder of the program, canonical.
    root: PathBuf,
    known: HashMap<PathBuf, FileId>,
    pub gathered: Vec<Gathered>,
    /// The imported files, also those that can't be read.
    pub reached: Vec<Watched>,
    /// Of the imports themselves.
    pub diagnostics: Vec<Diagnostic>,
}

impl<'a> Gathering<'a> {
    /// A program with all that it imports. `source`: named by its path.
    pub fn of(source: Source, files: &'a dyn Files, before: &'a [Gathered]) -> Gathering<'a> {
        let path = Path::new(&*source.name);
        let (canonical, root) = (files.canonical(path), files.canonical(&Path::new(".").join(folder(path))));
        let mut gathering = Gathering {
            files,
            before,
            root,
            known: HashMap::new(),
            gathered: Vec::new(),
            reached: Vec::new(),
            diagnostics: Vec::new(),
        };
        gathering.gather(source, canonical);
        gathering
    }

    /// Depth first, in the order written.
    fn gather(&mut self, source: Source, canonical: PathBuf) {
        let mut open = vec![self.add(source, canonical)];
        while let Some(Imports { by, left }) = open.last_mut() {
            let by = *by;
            match left.next() {
                None => drop(open.pop()),
                Some(import) => {
                    let (imported, its_own) = self.follow(&import, by);
                    self.gathered[by.0 as usize].imports.push(imported);
                    open.extend(its_own);
                }
            }
        }
    }

    fn add(&mut self, source: Source, canonical: PathBuf) -> Imports {
        let by = FileId(self.gathered.len() as u16);
        let parsed = self.parsed(&source, by);
        let imports = parsed.tree.forms.iter().filter_map(|form| match form {
            Form::Import(import) => Some(import.file.clone()),
            _ => None,
        });
        let left = imports.collect::<Vec<_>>().into_iter();
        let qualifier = qualifier(&self.root, &canonical);
        self.known.insert(canonical, by);
        self.gathered.push(Gathered { source, parsed, imports: Vec::new(), qualifier });
        Imports { by, left }
    }

    fn parsed(&self, source: &Source, id: FileId) -> Rc<Parsed> {
        let before = self.before.get(id.0 as usize).filter(|before| before.source.text == source.text);
        before.map_or_else(|| Rc::new(parse(source, id)), |before| Rc::clone(&before.parsed))
    }

    /// The file an import leads to, and what that imports in turn where it is new.
    fn follow(&mut self, import: &ast::Name, by: FileId) -> (Option<FileId>, Option<Imports>) {
        let by = self.gathered[by.0 as usize].source.name.clone();
        let path = folder(Path::new(&*by)).join(&*import.text);
        let canonical = self.files.canonical(&path);
        // Not so where a folder is a link.
        let path = Some(plain(&path)).filter(|plain| self.files.canonical(plain) == canonical).unwrap_or(path);
        if let Some(&known) = self.known.get(&canonical) {
            return (Some(known), None);
        }
        if self.gathered.len() == files::MOST {
            self.too_many(import);
            return (None, None);
        }
        let read = self.files.read(&path);
        let text = read.as_ref().ok().map(|source| source.text.clone());
        if self.reached.iter().all(|reached| reached.path != path) {
            self.reached.push(Watched { path, text });
        }
        match read {
            Ok(source) => {
                let imports = self.add(source, canonical);
                (Some(imports.by), Some(imports))
            }
            Err(why) => {
                self.diagnostics.push(unreadable(import, &by, &why));
                (None, None)
            }
        }
    }

    /// Said once: what keeps the first from being read keeps all others.
    fn too_many(&mut self, import: &ast::Name) {
        if self.diagnostics.iter().any(|it| it.code == Code::TooManyFiles) {
            return;
        }
        let message = format!("this would be one file more than the {} that a program may have", files::MOST);
        let help = "check that it imports what was meant, or put several of the files into one";
        self.diagnostics.push(Diagnostic::error(Code::TooManyFiles, import.span, message).help(help));
    }
}

/// What begins the paths of a file's own machines: how to get there from the program's folder.
fn qualifier(root: &Path, file: &Path) -> String {
    let parts: Vec<_> = relative(root, file).iter().map(|part| part.to_string_lossy().into_owned()).collect();
    parts.join(":").replace('/', "")
}

/// `by`: the name of the file that the import stands in.
fn unreadable(import: &ast::Name, by: &str, why: &Unreadable) -> Diagnostic {
    let said = |message: String| Diagnostic::error(Code::UnreadableImport, import.span, message);
    match why {
        Unreadable::Missing { path, nearest } => {
            let missing = said(format!("there is no file `{}` to import", path.display()));
            let beside = |name: &String| match import.text.rsplit_once('/') {
                Some((folder, _)) => format!("{folder}/{name}"),
                None => name.clone(),
            };
            let is_other = |name: &&String| path.with_file_name(name) != Path::new(by);
            match nearest.as_ref().filter(is_other).map(beside) {
                Some(near) => missing.help(format!("did you mean `{near}`?")),
                None => missing.help("an import names a file as seen from the folder of the file it stands in"),
            }
        }
        why => said(format!("this import can't be read: {why}")),
    }
}
