//! `lrp check --explain`: what a finding's code means, from docs/codes.md.

use std::process::ExitCode;

use super::output::{fail, finish};
use crate::syntax::Code;
use crate::syntax::nearest::nearest;

const PAGE: &str = include_str!("../../docs/codes.md");
const HEADING: &str = "\n## ";

/// Asks for all codes, a line each.
pub const LIST: &str = "list";

pub fn explain(code: &str) -> ExitCode {
    if code == LIST {
        let lines = sections().map(|(name, text)| format!("{name:20} {}\n", first_sentence(text)));
        return finish(&lines.collect::<String>(), ExitCode::SUCCESS);
    }
    match sections().find(|&(name, _)| name == code) {
        Some((name, text)) => finish(&format!("{name}\n\n{}", plain(text)), ExitCode::SUCCESS),
        None => {
            let help = match nearest(code, Code::ALL.iter().map(|code| code.name())) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "`lrp check --explain` lists them".to_string(),
            };
            fail(format_args!("no finding has the code `{code}`; {help}"))
        }
    }
}

/// Each code with what the page says of it, in its order.
fn sections() -> impl Iterator<Item = (&'static str, &'static str)> {
    PAGE.split(HEADING).skip(1).filter_map(|section| section.split_once("\n\n"))
}

fn first_sentence(text: &str) -> String {
    let paragraph = text.split("\n\n").next().unwrap_or_default().replace('\n', " ");
    let end = paragraph.find([':', ';']).unwrap_or(paragraph.len());
    match paragraph[..end].split_once(". ") {
        Some((first, _)) => first.to_string(),
        None => paragraph[..end].trim_end_matches('.').to_string(),
    }
}

/// For a terminal: examples are indented under what they are.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    let mut example = false;
    for line in text.trim_end().lines() {
        match line.strip_prefix("```") {
            Some("lrp wrong") => plain += "Wrong:\n\n",
            Some("lrp") => plain += "Right:\n\n",
            None if example && !line.is_empty() => plain += &format!("    {line}\n"),
            None => plain += &format!("{line}\n"),
            Some(_) => {}
        }
        example ^= line.starts_with("```");
    }
    plain
}
