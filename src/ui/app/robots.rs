//! The bridge pane: which row a person is at, sending by hand, and taking what is seen there into the program's text.

use tui_input::Input;

use super::movement::Move;
use super::{App, Effect, Goal, Overlay, Text, Typing, WriteBack};
use crate::model::settings::{Setting, with_setting};
use crate::session::write_back::Rewrite;
use crate::ui::layout::Pane;
use crate::ui::robots::{self, Key, Row};
use crate::ui::view::Path;

impl App {
    pub fn robot_rows(&self) -> Vec<Row<'_>> {
        robots::rows(&self.view, &self.robots_filter)
    }

    pub fn robots_top(&self) -> usize {
        self.robots_scroll.top()
    }

    /// A part of the names of what is seen there; empty: all.
    pub fn robots_filter(&self) -> &str {
        &self.robots_filter
    }

    pub fn selected_robot_row(&self) -> Option<&Key> {
        self.robot_row.as_ref()
    }

    pub(super) fn go_in_robots(&mut self, how: Move) {
        let keys: Vec<Key> = self.robot_rows().iter().filter_map(Row::key).collect();
        let at = keys.iter().position(|key| Some(key) == self.robot_row.as_ref());
        if let Some(to) = how.from(at, keys.len(), self.page(Pane::Bridge)) {
            self.robot_row = Some(keys[to].clone());
        }
    }

    pub(super) fn settle_robots(&mut self, height: usize) {
        let (length, at) = {
            let rows = self.robot_rows();
            let at = rows.iter().position(|row| row.key().is_some() && row.key() == self.robot_row);
            (rows.len(), at)
        };
        self.robots_scroll.settle(at, length, height);
    }

    /// What the selected row offers to be done: sent by hand, or written into the program.
    pub(super) fn tell(&mut self) -> Vec<Effect> {
        let rows = self.robot_rows();
        let row = rows.iter().find(|row| row.key().is_some() && row.key() == self.robot_row);
        let Some(row) = row else { return self.say("nothing is selected; Down selects the first row") };
        let robot = row.robot.clone();
        let (goal, text) = match (row.told(), row.setting()) {
            (Some(text), _) => (Goal::Tell(robot), text),
            (None, Some(text)) => (Goal::Setting(robot), text),
            (None, None) => (Goal::Tell(robot), String::new()),
        };
        // Words of lrp's are to be changed, not to be replaced as a whole.
        self.overlay = Overlay::Typing(Typing { goal, input: Input::new(text), text: Text::Typed });
        Vec::new()
    }

    /// The program's text with one more setting: saved, it is taken over like any edit, and reconnects nothing.
    pub(super) fn write_setting(&mut self, robot: &Path, text: &str) -> Vec<Effect> {
        let Some(program) = self.view.program.clone() else { return self.say("there is no program") };
        let changed = Setting::read(text).and_then(|setting| with_setting(&program, robot, &setting));
        match changed {
            Err(why) => self.say(why),
            Ok((file, to)) => {
                let source = &program.sources[usize::from(file.0)];
                let rewrite = Rewrite { file: source.name.clone(), from: source.text.clone(), to };
                self.overlay = Overlay::Nothing;
                vec![Effect::WriteBack(vec![WriteBack {
                    rewrite,
                    values: Vec::new(),
                    setting: Some(text.to_string()),
                }])]
            }
        }
    }
}
