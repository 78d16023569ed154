//! Colours can be read on the ground they are for, and nothing needs them.

use lrp::ui::theme::{Palette, Role, TABLE, Theme, style};
use ratatui::style::{Color, Modifier, Style};

/// The 16 colours of xterm and of VGA.
const XTERM: [u32; 16] = [
    0x000000, 0xcd0000, 0x00cd00, 0xcdcd00, 0x0000ee, 0xcd00cd, 0x00cdcd, 0xe5e5e5, 0x7f7f7f, 0xff0000, 0x00ff00,
    0xffff00, 0x5c5cff, 0xff00ff, 0x00ffff, 0xffffff,
];
const VGA: [u32; 16] = [
    0x000000, 0xaa0000, 0x00aa00, 0xaa5500, 0x0000aa, 0xaa00aa, 0x00aaaa, 0xaaaaaa, 0x555555, 0xff5555, 0x55ff55,
    0xffff55, 0x5555ff, 0xff55ff, 0x55ffff, 0xffffff,
];

fn number(colour: Color) -> usize {
    use Color::*;
    let order = [
        Black,
        Red,
        Green,
        Yellow,
        Blue,
        Magenta,
        Cyan,
        Gray,
        DarkGray,
        LightRed,
        LightGreen,
        LightYellow,
        LightBlue,
        LightMagenta,
        LightCyan,
        White,
    ];
    order.iter().position(|&known| known == colour).expect("one of the 16")
}

/// As the rules for readable pages have it.
fn luminance(rgb: u32) -> f64 {
    let linear = |shift: u32| {
        let part = f64::from(rgb >> shift & 0xff) / 255.0;
        if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * linear(16) + 0.7152 * linear(8) + 0.0722 * linear(0)
}

fn contrast(a: u32, b: u32) -> f64 {
    let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
    (a / b).max(b / a)
}

#[test]
fn every_colour_can_be_read_on_its_ground() {
    for (palette, ground) in [(Palette::Dark, 0x000000), (Palette::Light, 0xffffff)] {
        let theme = Theme::of(palette);
        for meaning in TABLE {
            let style = theme.style(meaning.role);
            let Some(colour) = style.fg else { continue };
            for terminal in [XTERM, VGA] {
                let number = number(colour);
                // Many terminals brighten what is bold.
                let bold = style.add_modifier.contains(Modifier::BOLD).then(|| terminal[number | 8]);
                for seen in bold.into_iter().chain([terminal[number]]) {
                    let contrast = contrast(seen, ground);
                    assert!(contrast > 2.5, "{} in {palette:?}: {seen:06x} has {contrast:.1}", meaning.id);
                }
            }
        }
    }
}

#[test]
fn without_colours_weight_tells() {
    let theme = Theme::of(Palette::Mono);
    assert!(TABLE.iter().all(|meaning| theme.style(meaning.role).fg.is_none()));
    for role in [Role::Active, Role::Fresh, Role::Error, Role::Warning, Role::Held, Role::Selected, Role::Running] {
        assert_ne!(theme.style(role), Style::new(), "{role:?}");
    }
    assert_ne!(theme.style(Role::Error), theme.style(Role::Warning));
}

#[test]
fn every_role_has_one_row_and_words_of_its_own() {
    for meaning in TABLE {
        assert_eq!(TABLE.iter().filter(|other| other.role == meaning.role || other.id == meaning.id).count(), 1);
    }
}

#[test]
fn styles_are_read_from_words() {
    assert_eq!(style("bold bright-red"), Ok(Style::new().fg(Color::LightRed).add_modifier(Modifier::BOLD)));
    assert_eq!(style("plain"), Ok(Style::new()));
    assert_eq!(style("blod red"), Err("`blod` is neither a colour nor a weight".into()));
}
