//! The files for editors in docs/editors: their lists of words are the table's, and they hold together as far as that can be
//! seen without the editors.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use lrp::syntax::keyword::Keyword;
use serde_json::Value;

fn editors() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/editors")
}

fn read(file: &str) -> String {
    fs::read_to_string(editors().join(file)).unwrap_or_else(|why| panic!("{file}: {why}"))
}

fn json(file: &str) -> Value {
    serde_json::from_str(&read(file)).unwrap_or_else(|why| panic!("{file}: {why}"))
}

/// The words between two marks, whatever separates them.
fn listed<'a>(text: &'a str, from: &str, to: &str) -> Vec<&'a str> {
    let (_, rest) = text.split_once(from).unwrap_or_else(|| panic!("no `{from}`"));
    let (list, _) = rest.split_once(to).unwrap_or_else(|| panic!("no `{to}` after `{from}`"));
    list.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect()
}

#[test]
fn their_words_are_those_of_the_language() {
    let all: BTreeSet<&str> = Keyword::ALL.iter().map(|keyword| keyword.name()).collect();
    let vscode = json("vscode/lrp/syntaxes/lrp.tmLanguage.json");
    let form = vscode["repository"]["form"]["match"].as_str().unwrap_or_default();
    for (file, words) in [
        ("vim", listed(&read("vim/syntax/lrp.vim"), "lrpKeyword contained", "\n")),
        ("nano", listed(&read("nano/lrp.nanorc"), "[[:space:]]*(", ")")),
        ("helix", listed(&read("helix/queries/lrp/highlights.scm"), "(#any-of? @keyword", "))")),
        ("vscode", listed(form, "\\s*(", ")")),
    ] {
        assert_eq!(words.len(), all.len(), "{file} has a word twice or too few");
        assert_eq!(words.into_iter().collect::<BTreeSet<_>>(), all, "{file}");
    }
}

/// Lua's own, where an editor has no Lua to call on.
#[test]
fn nano_knows_the_words_of_lua() {
    let words = listed(&read("nano/lrp.nanorc").replace("\\<", ""), "color green \"(", ")").join(" ");
    assert_eq!(
        words,
        "and break do else elseif end false for function goto if in local nil not or repeat return then true until while"
    );
}

#[test]
fn vims_files_end_what_they_begin() {
    let begins = [
        "\"",
        "\\",
        "if ",
        "endif",
        "finish",
        "let ",
        "unlet",
        "syntax ",
        "setlocal ",
        "augroup ",
        "autocmd",
        "silent! ",
        "highlight default link ",
    ];
    for file in ["ftdetect/lrp.vim", "ftplugin/lrp.vim", "plugin/lrp.vim", "syntax/lrp.vim"] {
        let text = read(&format!("vim/{file}"));
        let lines = || text.lines().map(str::trim).filter(|line| !line.is_empty());
        for line in lines() {
            assert!(begins.iter().any(|word| line.starts_with(word)), "{file}: {line}");
        }
        let count = |word: &str| lines().filter(|line| line.split(' ').next() == Some(word)).count();
        assert_eq!(count("if"), count("endif"), "{file}");
        let ends = lines().filter(|line| *line == "augroup END").count();
        assert_eq!(count("augroup"), 2 * ends, "{file}");
    }
    let syntax = read("vim/syntax/lrp.vim");
    let word = |line: &str, at: usize| line.split_whitespace().nth(at).unwrap_or_default().to_owned();
    let items = || syntax.lines().filter(|line| line.starts_with("syntax "));
    let groups = items().flat_map(|line| line.split("matchgroup=").skip(1)).map(|rest| word(rest, 0));
    let defined: BTreeSet<String> = items().map(|line| word(line, 2)).chain(groups).collect();
    for line in syntax.lines().filter(|line| line.starts_with("highlight ")) {
        assert!(defined.contains(&word(line, 3)), "nothing is {line}");
    }
}

#[test]
fn nanos_rules_are_whole() {
    let text = read("nano/lrp.nanorc");
    for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
        let (command, rest) = line.split_once(' ').unwrap_or_default();
        assert!(["syntax", "comment", "color"].contains(&command), "{line}");
        assert!(rest.contains('"') && rest.ends_with('"'), "{line}");
        let open = rest.matches('(').count() - rest.matches("\\(").count() - rest.matches("[()]").count();
        let close = rest.matches(')').count() - rest.matches("\\)").count() - rest.matches("[()]").count();
        assert_eq!(open, close, "{line}");
    }
}

#[test]
fn vscodes_files_name_what_is_there() {
    let package = json("vscode/lrp/package.json");
    let at = |path: &Value| editors().join("vscode/lrp").join(path.as_str().unwrap_or("nothing"));
    let (language, grammar) = (&package["contributes"]["languages"][0], &package["contributes"]["grammars"][0]);
    assert!(at(&language["configuration"]).is_file() && at(&grammar["path"]).is_file());
    json("vscode/lrp/language-configuration.json");
    let rules = json("vscode/lrp/syntaxes/lrp.tmLanguage.json");
    assert_eq!(rules["scopeName"], grammar["scopeName"]);
    let text = rules.to_string();
    for name in text.split("\"include\":\"#").skip(1).filter_map(|rest| rest.split('"').next()) {
        assert!(rules["repository"][name].is_object(), "#{name}");
    }
    assert!(grammar["embeddedLanguages"][rules["repository"]["block"]["name"].as_str().unwrap_or_default()] == "lua");
}

#[test]
fn helixs_queries_ask_for_nodes_that_the_grammar_has() {
    let nodes = json("helix/tree-sitter-lrp/src/node-types.json");
    let known: BTreeSet<&str> =
        nodes.as_array().into_iter().flatten().filter_map(|node| node["type"].as_str()).collect();
    for file in ["highlights.scm", "injections.scm"] {
        let text = read(&format!("helix/queries/lrp/{file}"));
        let code: String =
            text.lines().map(|line| if line.starts_with(';') { "" } else { line }).collect::<Vec<_>>().join("\n");
        for (open, close) in [('(', ')'), ('[', ']')] {
            let outside = code.replace(&format!("\"{open}\""), "").replace(&format!("\"{close}\""), "");
            assert_eq!(outside.matches(open).count(), outside.matches(close).count(), "{file}");
        }
        for name in
            code.split('(').skip(1).map(|rest| rest.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default())
        {
            assert!(name.is_empty() || known.contains(name), "{file}: ({name} ...)");
        }
    }
    assert!(read("helix/tree-sitter-lrp/src/parser.c").contains("tree_sitter_lrp"));
}

#[test]
fn each_editor_has_a_page_and_the_pages_name_files_that_are_there() {
    let index = read("README.md");
    for entry in fs::read_dir(editors()).expect("the folder").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        assert!(name == "README.md" || index.contains(&format!("({name})")), "README.md lacks {name}");
        if entry.path().is_dir() {
            let page = read(&format!("{name}.md"));
            let files =
                page.split("docs/editors/").skip(1).map(|rest| rest.split([' ', '`', '*']).next().unwrap_or_default());
            let mut some = false;
            for file in files {
                some = true;
                assert!(editors().join(file.trim_end_matches('/')).exists(), "{name}.md: {file}");
            }
            assert!(some, "{name}.md says what to copy");
        }
    }
}
