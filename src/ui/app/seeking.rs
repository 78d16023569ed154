//! Looking for words in the program's text.

use tui_input::Input;

use super::{App, Effect, Goal, Overlay, Text as Typed, TextLine, Typing};
use crate::ui::layout::Way;
use crate::ui::text::Text;

impl App {
    pub(super) fn ask_for_words(&mut self) -> Vec<Effect> {
        let input = Input::new(self.sought.clone());
        self.overlay = Overlay::Typing(Typing { goal: Goal::Words, input, text: Typed::Present });
        Vec::new()
    }

    pub(super) fn seek(&mut self, words: String) -> Vec<Effect> {
        self.overlay = Overlay::Nothing;
        self.sought = words;
        self.find(Way::On)
    }

    /// Goes to the next line, or the one before, in which the words stand, round the end of the text.
    pub(super) fn find(&mut self, way: Way) -> Vec<Effect> {
        let Some((at, Text { source, .. })) = self.text() else { return Vec::new() };
        if self.sought.is_empty() {
            return self.say("nothing is looked for yet");
        }
        let (count, words) = (source.line_count(), self.sought.to_lowercase());
        let line = |step: usize| match way {
            Way::On => (at.line - 1 + step) % count + 1,
            Way::Back => (at.line - 1 + count - step) % count + 1,
        };
        let found = (1..=count).map(line).find_map(|line| {
            let range = source.line_range(line);
            let place = source.text[range.clone()].to_lowercase().find(&words)?;
            Some((TextLine { line, ..at }, (range.start + place).min(range.end)))
        });
        match found {
            Some((line, offset)) => {
                self.go_to_text(line, offset);
                Vec::new()
            }
            None => self.say(format!("`{}` isn't in this text", self.sought)),
        }
    }
}
