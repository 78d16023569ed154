//! Which editor is opened, how and where; and that names of files stay names.

use std::ffi::OsString;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

use lrp::ui::editor::{Launch, Manner, Multiplexer, NoEditor, Surroundings, command_line};
use ratatui::layout::Size;

/// Else vim takes the file for an archive.
const FOR_VIM: [&str; 2] = ["--cmd", "let g:loaded_tarPlugin=1"];

fn strings(command: Vec<OsString>) -> Vec<String> {
    command.into_iter().map(|word| word.into_string().unwrap()).collect()
}

#[test]
fn each_editor_is_told_the_line_in_its_own_way() {
    let table: &[(&str, &[&str])] = &[
        ("vim", &["vim", FOR_VIM[0], FOR_VIM[1], "+call cursor(12,5)", "a.lrp"]),
        ("/usr/bin/vim.basic -n", &["/usr/bin/vim.basic", "-n", FOR_VIM[0], FOR_VIM[1], "+call cursor(12,5)", "a.lrp"]),
        ("nvim", &["nvim", FOR_VIM[0], FOR_VIM[1], "+call cursor(12,5)", "a.lrp"]),
        ("vi", &["vi", "+12", "a.lrp"]),
        ("nano", &["nano", "+12,5", "a.lrp"]),
        ("emacs -nw", &["emacs", "-nw", "+12:5", "a.lrp"]),
        ("emacsclient -nw -a ''", &["emacsclient", "-nw", "-a", "", "+12:5", "a.lrp"]),
        ("hx", &["hx", "a.lrp:12:5"]),
        ("helix", &["helix", "a.lrp:12:5"]),
        ("kak", &["kak", "+12:5", "a.lrp"]),
        ("micro", &["micro", "+12:5", "a.lrp"]),
        ("code --wait", &["code", "--wait", "--goto", "a.lrp:12:5"]),
        ("subl", &["subl", "a.lrp:12:5"]),
        ("ed", &["ed", "a.lrp"]),
        (
            r#""/opt/my ed/vim" -c 'set nu' a\ b"#,
            &["/opt/my ed/vim", "-c", "set nu", "a b", FOR_VIM[0], FOR_VIM[1], "+call cursor(12,5)", "a.lrp"],
        ),
        ("  $(reboot) ", &["$(reboot)", "a.lrp"]),
    ];
    for (editor, expected) in table {
        assert_eq!(strings(command_line(editor, Path::new("a.lrp"), 12, 5)), *expected, "{editor}");
    }
}

#[test]
fn a_file_named_like_an_option_is_still_a_file() {
    assert_eq!(strings(command_line("vi", Path::new("-c!sh"), 1, 1)), ["vi", "+1", "./-c!sh"]);
    assert_eq!(strings(command_line("hx", Path::new("+x"), 1, 2)), ["hx", "./+x:1:2"]);
    assert_eq!(strings(command_line("vi", Path::new("a; b"), 1, 1)), ["vi", "+1", "a; b"]);
}

/// A folder with these programs, and surroundings that search nothing else.
fn around(programs: &[&str], editor: Option<&str>) -> (tempfile::TempDir, Surroundings) {
    let folder = tempfile::tempdir().unwrap();
    for name in programs {
        let path = folder.path().join(name);
        fs::write(&path, "#!/bin/sh\n").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }
    let around = Surroundings {
        editor: editor.map(str::to_owned),
        search: folder.path().into(),
        multiplexer: Multiplexer::None,
        size: Size { width: 80, height: 24 },
    };
    (folder, around)
}

#[test]
fn without_a_wish_the_first_usual_editor_opens() {
    let (folder, around) = around(&["vi", "vim"], None);
    let launch = Launch::new(Path::new("a.lrp"), 2, 3, &around).unwrap();
    assert_eq!(launch.manner, Manner::Covering);
    assert_eq!(launch.command[0], folder.path().join("vim"));
}

#[test]
fn a_missing_editor_is_told_in_a_sentence() {
    let (folder, mut around) = around(&[], Some("foo --bar"));
    let missing = Launch::new(Path::new("a.lrp"), 1, 1, &around).unwrap_err();
    assert_eq!(missing.to_string(), "the editor `foo` isn't there; set VISUAL or EDITOR to one that is");
    fs::write(folder.path().join("foo"), "no program").unwrap();
    assert_eq!(Launch::new(Path::new("a.lrp"), 1, 1, &around), Err(NoEditor::Missing { name: "foo".into() }));
    around.editor = None;
    let none = Launch::new(Path::new("a.lrp"), 1, 1, &around).unwrap_err();
    assert_eq!(none.to_string(), "no editor found; set VISUAL or EDITOR to the one you use");
}

#[test]
fn in_tmux_the_pane_is_split_along_its_longer_side() {
    let (_folder, mut around) = around(&["vi", "code"], Some("vi"));
    around.multiplexer = Multiplexer::Tmux;
    let below = Launch::new(Path::new("a.lrp"), 1, 1, &around).unwrap();
    assert_eq!(below.manner, Manner::Split);
    assert_eq!(strings(below.command)[..3], ["tmux", "split-window", "-v"]);
    around.size.width = 200;
    let beside = Launch::new(Path::new("x.lrp;"), 1, 1, &around).unwrap();
    let words = strings(beside.command);
    assert_eq!(words[..3], ["tmux", "split-window", "-h"]);
    assert_eq!(words.last().unwrap(), r"x.lrp\;", "else tmux would see the end of its command");
    around.editor = Some("code".into());
    assert_eq!(Launch::new(Path::new("a.lrp"), 1, 1, &around).unwrap().manner, Manner::Window);
}
