//! The tour's tasks, in their order: what is said, what it needs, and what ends each. In the texts `{pause}` is the key of
//! the action of that name, `{file}` the program's file, and what stands in back quotes is written in a program.

use crate::ui::action::Action;
use crate::ui::layout::Pane;

/// Something a newcomer is asked to do once.
#[derive(Debug)]
pub struct Step {
    /// In the file that remembers what was done; never changed.
    pub id: &'static str,
    pub title: &'static str,
    pub task: &'static str,
    pub until: Until,
    /// Without these it can't be done.
    pub needs: &'static [Need],
    /// Three words.
    pub praise: &'static str,
}

/// What ends a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// These are done at the screen, so many times in all.
    Did(&'static [Action], usize),
    /// A save changes what runs.
    Changed,
    /// The text can't be taken over.
    Broken,
    /// It can, again.
    Mended,
    /// A value is set by hand.
    Tuned,
    /// A value is in the file.
    Written,
    /// A state is gone to.
    Sent,
    /// It doesn't run.
    Paused,
    /// So many steps are made by hand.
    Stepped(usize),
    /// It runs.
    Going,
    /// A save waits.
    Held,
    /// None waits, and saves count at once.
    Decided,
    /// The robot is stopped.
    Stopped,
}

/// What has to be so, and what is said where it isn't.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Saves count at once.
    Taken,
    /// What runs is what the files say.
    Sound,
    /// Any machine runs.
    Alive,
    /// Time goes on.
    Going,
}

impl Need {
    pub fn way_back(self) -> &'static str {
        match self {
            Need::Taken => {
                "Saves are held just now: {apply-held} takes the one that waits, {saves} lets saves count at once."
            }
            Need::Sound => {
                "The text can't be taken over; the log says why. Mend it in your editor and save, then go on here."
            }
            Need::Alive => "No machine runs any more. Undo the last edit and save, or {restart} to begin again.",
            Need::Going => "The program is paused. {pause} lets it go on.",
        }
    }
}

pub const STEPS: &[Step] = &[
    Step {
        id: "look",
        title: "look",
        task: "A robot in a simulated room; its program is a machine with states. {toggle-world} shows the room, \
               {toggle-world} again the machine.",
        until: Until::Did(&[Action::ToggleWorld, Action::Focus(Pane::World), Action::Focus(Pane::Graph)], 2),
        needs: &[],
        praise: "There it drives.",
    },
    Step {
        id: "edit",
        title: "edit while it runs",
        task: "Press {open-editor} for your editor, or open {file} in another window. Make `speed` 0.4 and save: nothing \
               begins again.",
        until: Until::Changed,
        needs: &[Need::Taken, Need::Sound],
        praise: "It counts already.",
    },
    Step {
        id: "break",
        title: "break it",
        task: "Break it: delete any bracket in the text and save. The robot won't mind.",
        until: Until::Broken,
        needs: &[],
        praise: "Still it drives.",
    },
    Step {
        id: "mend",
        title: "mend it",
        task: "The first line says what is wrong and where; the last good program goes on. Mend the text and save.",
        until: Until::Mended,
        needs: &[],
        praise: "Whole once more.",
    },
    Step {
        id: "tune",
        title: "tune a number",
        task: "Back on this screen: {variables} for the variables, {down} until you are at `speed`, then {increase} and \
               {decrease} while you watch the robot.",
        until: Until::Tuned,
        needs: &[Need::Alive],
        praise: "Tuned while driving.",
    },
    Step {
        id: "write",
        title: "write it back",
        task: "The `*` says that the file doesn't have your number yet. {write-back} at the variable writes it, there and \
               nowhere else.",
        until: Until::Written,
        needs: &[Need::Taken, Need::Sound, Need::Alive],
        praise: "Saved for good.",
    },
    Step {
        id: "jump",
        title: "don't wait",
        task: "After five minutes it dances. Don't wait for that: {machines} for the machines, {down} to `dancing` (or \
               any state), {jump-to} to jump there.",
        until: Until::Sent,
        needs: &[Need::Alive, Need::Going],
        praise: "Five minutes saved.",
    },
    Step {
        id: "why",
        title: "why not",
        task: "Why is a state not left? {why-not} tells what each way out of the selected one waits for; {why-not} again leads \
               back.",
        until: Until::Did(&[Action::WhyNot, Action::Inspect], 2),
        needs: &[Need::Alive],
        praise: "Asked and answered.",
    },
    Step {
        id: "pause",
        title: "pause",
        task: "{pause} pauses, whenever you want to think. The simulated robot stands still meanwhile.",
        until: Until::Paused,
        needs: &[],
        praise: "Time stands still.",
    },
    Step {
        id: "step",
        title: "step",
        task: "{step} makes one step, a tenth of a second. Make three, and watch the numbers and the log.",
        until: Until::Stepped(3),
        needs: &[Need::Alive],
        praise: "Step by step.",
    },
    Step {
        id: "run",
        title: "run on",
        task: "{pause} again lets it run on.",
        until: Until::Going,
        needs: &[],
        praise: "On it goes.",
    },
    Step {
        id: "hold",
        title: "hold a save",
        task: "Near people, look before an edit counts: {saves} holds saves. Then load the text anew, since it has your \
               number, change `spin`, and save.",
        until: Until::Held,
        needs: &[Need::Sound],
        praise: "Nothing changed yet.",
    },
    Step {
        id: "apply",
        title: "apply it",
        task: "{held-edit} lists what it would do, {apply-held} applies it, {drop-held} drops it. Then {saves} once more, so \
               that saves count at once.",
        until: Until::Decided,
        needs: &[],
        praise: "You decided when.",
    },
    Step {
        id: "stop",
        title: "stop the robot",
        task: "The key to remember: {runstop} stops the robot at once, {runstop-always} also while you type. Press it now.",
        until: Until::Stopped,
        needs: &[],
        praise: "Safe and sound.",
    },
];

/// What is said when all is done.
pub const END: &str = "That was the tour. {pause} lets the robot go on, {tour-next} begins the tour again, {help} lists all keys; {quit} quits \
     and tells what else there is.";

/// Instead of the end, where tasks were skipped.
pub const SKIPPED: &str = "The tour is through, but for what you skipped: {tour-next} takes that up. {quit} quits.";

/// For the shell, after the tour: whole or not.
pub const ELSE: &str = "
What else there is:
  renames         in the text go through while it runs
  breakpoints     {breakpoint} at a state, {break-when} for a condition, (break) in the text
  {on-edit}               has edits of active states begin nothing again
  lrp new NAME    a program of your own, in the simulator
  lrp check FILE  what is wrong before it runs; --explain CODE tells more
  lrp graph FILE  the drawing of a machine
  lrp test        tests of behaviours, in virtual time
  docs/           language.md: every form; liveness.md: what an edit does;
                  sim.md: the simulator; editors/: colours and autosave
";
