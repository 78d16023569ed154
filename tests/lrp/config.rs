//! Configuration files: what they change and what is wrong with them. A case is a file; `UPDATE=1` writes the answers.

use std::ffi::OsString;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use lrp::runtime::command::Command;
use lrp::ui::action::{Action, TABLE};
use lrp::ui::app::Effect;
use lrp::ui::config::{Config, Look, Place};
use lrp::ui::glyphs::Charset;
use lrp::ui::key::Key;
use lrp::ui::keymap::Keymap;
use lrp::ui::layout::Pane;
use lrp::ui::settings::{Settings, Surroundings};
use lrp::ui::theme::{self, Palette, Theme};
use proptest::prelude::*;
use ratatui::layout::Size;

use crate::frames::{check, frame, press, screen_with};
use crate::story::Story;

/// What differs from the defaults, then what was found.
fn answer(text: &str) -> String {
    let config = Config::read("config.toml", text);
    let mut answer = String::new();
    for (entry, keys) in config.keys.rows().filter(|(entry, keys)| *keys != entry.default_keys()) {
        let keys: Vec<String> = keys.iter().map(Key::to_string).collect();
        let _ = writeln!(answer, "{}: {}", entry.id, keys.join(" "));
    }
    if config.look != Look::default() {
        let Look { palette, charset, mouse } = config.look;
        let _ = writeln!(answer, "{palette:?} {charset:?} {mouse:?}");
    }
    for (id, style) in &config.colours {
        let _ = writeln!(answer, "{id}: {style:?}");
    }
    for finding in &config.findings {
        let _ = writeln!(answer, "{}:{}: {}: {}", finding.line, finding.column, finding.severity, finding.message);
        finding.help.iter().for_each(|help| _ = writeln!(answer, "    {help}"));
    }
    answer
}

#[test]
fn cases() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/config");
    let mut cases = 0;
    for path in fs::read_dir(folder).expect("a folder").flatten().map(|entry| entry.path()) {
        if path.extension().is_some_and(|it| it == "toml") {
            let seen = answer(&fs::read_to_string(&path).expect("a case"));
            let expected = path.with_extension("txt");
            cases += 1;
            if std::env::var_os("UPDATE").is_some() {
                fs::write(expected, seen).expect("the answer is written");
            } else {
                let wanted = fs::read_to_string(&expected).unwrap_or_default();
                assert!(seen == wanted, "{}:\n{seen}\nwas:\n{wanted}", path.display());
            }
        }
    }
    assert!(cases > 5);
}

fn configured(text: &str) -> Settings {
    let config = Config::read("config.toml", text);
    assert_eq!(config.findings, [], "{text}");
    config.settings(Look::default(), &Surroundings { locale: Some("C.UTF-8".into()), ..Surroundings::default() })
}

#[test]
fn the_keys_that_are_shown_are_the_keys_that_work() {
    let text = "[keys]\npause = 'F5'\nrunstop = 'F8'\nrunstop-always = 'Ctrl-E'\nhelp = 'F1'\npalette = 'F2'\nback = 'q'\nquit = []\n";
    let settings = configured(text);
    let mut app = screen_with(settings, Size::new(80, 24), &Story::searching());
    assert_eq!(press(&mut app, "F5"), vec![Effect::Command(Command::Pause)]);
    assert_eq!(press(&mut app, "F8"), vec![Effect::Command(Command::Runstop)]);
    assert_eq!(press(&mut app, "!"), Vec::new());
    assert_eq!(app.message(), Some("! does nothing here; F1 lists the keys"));
    press(&mut app, "Down");
    check("configured_80x24", &app);
    press(&mut app, "F1");
    let help = frame(&app);
    assert!(help.contains("F8") && help.contains("q back") && !help.contains("Space"), "{help}");
    press(&mut app, "q F2");
    assert!(frame(&app).contains("Ctrl-E STOP"));
    assert_eq!(press(&mut app, "Ctrl-E"), vec![Effect::Command(Command::Runstop)], "also while typing");
}

#[test]
fn what_is_wrong_is_in_the_log_and_stays_there() {
    let story = Story::searching();
    let mut app = screen_with(Settings::default(), Size::new(80, 24), &Story::new());
    let config = Config::read("/home/me/.config/lrp/config.toml", "[keys]\nstpe = 's'\n");
    app.found_in_config(&config.findings);
    story.records.iter().for_each(|record| app.record(record));
    check("misconfigured_80x24", &app);
    let open = press(&mut app, "4 Down Enter");
    let file = "/home/me/.config/lrp/config.toml".into();
    assert_eq!(open, vec![Effect::OpenEditor { file, line: 2, column: 1 }]);
}

#[test]
fn what_is_said_first_counts() {
    let light = Surroundings { colorfgbg: Some("0;15".into()), ..Surroundings::default() };
    let theme = |text: &str, said: Option<Palette>| {
        let look = Look { palette: said, ..Look::default() };
        Config::read("", text).settings(look, &light).theme
    };
    assert_eq!(theme("", None), Theme::of(Palette::Light));
    assert_eq!(theme("theme = 'auto'", None), Theme::of(Palette::Light));
    assert_eq!(theme("theme = 'mono'", None), Theme::of(Palette::Mono));
    assert_eq!(theme("theme = 'mono'", Some(Palette::Dark)), Theme::of(Palette::Dark));
    let colours = "[colours]\nactive = 'red'\n";
    assert_ne!(theme(colours, Some(Palette::Dark)), Theme::of(Palette::Dark));
    assert_eq!(theme(colours, Some(Palette::Mono)), Theme::of(Palette::Mono), "no colours are none");
    let charset = |text: &str| Config::read("", text).settings(Look::default(), &light).charset;
    assert_eq!((charset(""), charset("ascii = false")), (Charset::Ascii, Charset::Unicode));
}

#[test]
fn the_file_is_looked_for_in_order() {
    let find = |said: Option<&str>, vars: &[(&str, &str)]| {
        let var = |name: &str| vars.iter().find(|(known, _)| *known == name).map(|(_, value)| OsString::from(value));
        Place::find(said.map(Path::new), var)
    };
    let all = [("LRP_CONFIG", "/a.toml"), ("XDG_CONFIG_HOME", "/x"), ("HOME", "/h")];
    let path = |text: &str| PathBuf::from(text);
    assert_eq!(find(Some("b.toml"), &all), Place::Named(path("b.toml")));
    assert_eq!(find(None, &all), Place::Named(path("/a.toml")));
    assert_eq!(find(None, &all[1..]), Place::Usual(path("/x/lrp/config.toml")));
    assert_eq!(
        find(None, &[("XDG_CONFIG_HOME", "x"), ("HOME", "/h")]),
        Place::Usual(path("/h/.config/lrp/config.toml"))
    );
    assert_eq!(find(None, &[("LRP_CONFIG", ""), ("HOME", "/h")]), Place::Nowhere);
    assert_eq!(find(None, &[("HOME", "")]), Place::Nowhere);
}

#[test]
fn defaults_are_what_a_file_may_say() {
    let row = |entry: &lrp::ui::action::Entry| format!("{} = {:?}\n", entry.id, entry.keys);
    let text: String = TABLE.iter().map(row).collect();
    let config = Config::read("", &format!("[keys]\n{text}"));
    assert_eq!(config, Config::default());
}

#[test]
fn the_page_tells_what_there_is() {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/config.md")).expect("the page");
    for example in page.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()) {
        assert_eq!(Config::read("", example).findings, [], "{example}");
    }
    let missing: Vec<&str> =
        theme::TABLE.iter().map(|meaning| meaning.id).filter(|id| !page.contains(&format!("`{id}`"))).collect();
    assert_eq!(missing, [""; 0], "roles");
}

fn keys() -> impl Strategy<Value = String> {
    let defaults = TABLE.iter().flat_map(|entry| entry.keys.iter().copied());
    let others = ["F5", "F6", "Alt-a", "x", "Ctrl-I", "nonsense", "ü", "Shift-F1", ""];
    prop::sample::select(defaults.chain(others).map(str::to_owned).collect::<Vec<_>>())
}

proptest! {
    /// Whatever a file says, the runstop has its keys, always and in each pane, and no key means two things.
    #[test]
    fn any_rows_leave_a_keymap_that_can_be_used(
        rows in prop::collection::btree_map(0..TABLE.len(), prop::collection::vec(keys(), 0..3), 0..12),
    ) {
        let text: String = rows.iter().map(|(row, keys)| format!("{} = {keys:?}\n", TABLE[*row].id)).collect();
        let keys: Keymap = Config::read("", &format!("[keys]\n{text}")).keys;
        for (entry, own) in keys.rows() {
            for (other, others) in keys.rows().filter(|(other, _)| entry.clashes_with(other)) {
                prop_assert!(!own.iter().any(|key| others.contains(key)), "{} and {}", entry.id, other.id);
            }
            if entry.action == Action::Runstop {
                prop_assert!(!own.is_empty());
                for pane in [Pane::Machines, Pane::Graph, Pane::Variables, Pane::Log, Pane::World, Pane::Detail] {
                    prop_assert!(own.iter().all(|&key| keys.action(key, pane) == Some(Action::Runstop)));
                }
            }
        }
    }

    #[test]
    fn any_text_is_read(text in "(\\[keys\\]\n)?(step|theme|\\[colours\\]|[a-z]{0,5})? ?=? ?[\\[\"']?[ -~]{0,12}[\\]\"']?\n?\\PC{0,12}") {
        let config = Config::read("", &text);
        prop_assert!(config.findings.iter().all(|finding| finding.line > 0 && finding.column > 0));
    }
}
