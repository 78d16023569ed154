//! What the environment tells of the terminal: its ground and its characters.

use lrp::ui::glyphs::Charset;
use lrp::ui::settings::Surroundings;
use lrp::ui::theme::Palette;

#[test]
fn the_ground_is_dark_unless_the_terminal_says_otherwise() {
    let palette = |no_color: &str, colours: &str| {
        let some = |text: &str| Some(text.to_owned()).filter(|text| !text.is_empty());
        Surroundings { no_color: some(no_color), colorfgbg: some(colours), ..Surroundings::default() }.palette()
    };
    assert_eq!(palette("", ""), Palette::Dark);
    assert_eq!(palette("", "15;0"), Palette::Dark);
    assert_eq!(palette("", "0;15"), Palette::Light);
    assert_eq!(palette("", "0;default;15"), Palette::Light);
    assert_eq!(palette("", "0;7"), Palette::Light);
    assert_eq!(palette("", "7;8"), Palette::Dark);
    assert_eq!(palette("", "15;default"), Palette::Dark);
    assert_eq!(palette("1", "0;15"), Palette::Mono);
    let old = Surroundings { term: Some("vt220".into()), ..Surroundings::default() };
    assert_eq!(old.palette(), Palette::Mono);
}

#[test]
fn characters_follow_the_locale() {
    let charset = |locale: Option<&str>, term: &str| {
        let (locale, term) = (locale.map(str::to_owned), Some(term.to_owned()));
        Surroundings { locale, term, ..Surroundings::default() }.charset()
    };
    for locale in ["en_GB.UTF-8", "C.utf8", "de_DE.utf-8@euro"] {
        assert_eq!(charset(Some(locale), "xterm"), Charset::Unicode, "{locale}");
        assert_eq!(charset(Some(locale), "linux"), Charset::Ascii, "{locale}");
        assert_eq!(charset(Some(locale), "vt100"), Charset::Ascii, "{locale}");
    }
    for locale in [None, Some("C"), Some("POSIX"), Some("de_DE"), Some("de_DE.ISO-8859-1")] {
        assert_eq!(charset(locale, "xterm"), Charset::Ascii, "{locale:?}");
    }
}
