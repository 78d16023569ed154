//! The operations of the matrix, done on a tree.

use super::base::{SITES, act, over, start};
use super::cell::{Cell, Kind, Of, On, Op, When};
use super::tree::*;

impl Cell {
    /// The program before the edit.
    pub fn before(&self) -> Tree {
        let mut tree = super::base::program();
        match (self.kind, self.op) {
            (Kind::Onpause, Op::Added) => tree.onpause = None,
            (Kind::Onresume, Op::Added) => tree.onresume = None,
            _ => {}
        }
        tree
    }

    pub fn begins_as_all(&self) -> bool {
        !matches!((self.kind, self.op), (Kind::Onpause | Kind::Onresume, Op::Added))
    }

    pub fn after(&self, mut tree: Tree) -> Tree {
        match self.kind {
            Kind::Bridge => self.bridge(&mut tree),
            Kind::Global => self.global(&mut tree),
            Kind::Variable => self.variable(&mut tree),
            Kind::Machine => self.machine(&mut tree),
            Kind::State => self.state(&mut tree),
            Kind::Event => self.event(&mut tree),
            Kind::Transition(on) => self.transition(&mut tree, on),
            Kind::Action(when) => self.action(&mut tree, when),
            Kind::NestedSpawn => self.nested_spawn(&mut tree),
            Kind::TopSpawn => self.top_spawn(&mut tree),
            Kind::Onpause => self.pause(&mut tree, |tree| &mut tree.onpause),
            Kind::Onresume => self.pause(&mut tree, |tree| &mut tree.onresume),
        }
        tree
    }

    fn role(&self) -> &'static str {
        match self.of {
            Of::Busy => "busy",
            Of::Off => "off",
        }
    }

    fn named(&self, role: &str) -> String {
        format!("{}_{role}", self.site.machine)
    }

    fn state_name(&self) -> String {
        self.named(self.role())
    }

    /// The other of the two states.
    fn other_state(&self) -> String {
        self.named(if self.of == Of::Busy { "off" } else { "busy" })
    }

    fn other_machine(&self) -> &'static str {
        match (self.kind, self.site.machine) {
            (Kind::Transition(On::Exit), "twin") => "nest",
            (Kind::Transition(On::Exit), _) => "twin",
            (_, "side") => "main",
            _ => "side",
        }
    }

    fn bridge(&self, tree: &mut Tree) {
        match self.op {
            Op::Added => tree.bridges.push(Bridge { name: "arm".into(), config: String::new() }),
            Op::Removed => tree.bridges.clear(),
            Op::Changed => tree.bridges[0].config = "stale = 600".into(),
            Op::Renamed => tree.bridges[0].name = "rover".into(),
            _ => tree.upside_down = true,
        }
    }

    fn global(&self, tree: &mut Tree) {
        let name = format!("g_{}", self.site.machine);
        let at = tree.vars.iter().position(|var| var.name == name).expect("each machine has one");
        match self.op {
            Op::Added => {
                let var = tree.var("g_new".into(), &[&name], 1);
                tree.vars.push(var);
            }
            Op::Removed => drop(tree.vars.remove(at)),
            Op::Changed => tree.vars[at].init.and = 20,
            Op::Renamed => rename(tree, |tree| &mut tree.vars[at].name),
            Op::Reordered => {
                let var = tree.vars.remove(at);
                tree.vars.insert(if at == 0 { tree.vars.len() } else { 0 }, var);
            }
            Op::Moved | Op::MovedOut => {
                let mut var = tree.vars.remove(at);
                var.id = tree.id();
                tree.machine(self.site.machine).vars.insert(0, var);
            }
        }
    }

    fn variable(&self, tree: &mut Tree) {
        let machine = self.site.machine;
        match self.op {
            Op::Added => {
                let var = tree.var(self.named("new"), &[&self.named("a")], 2);
                tree.machine(machine).vars.push(var);
            }
            Op::Removed => drop(tree.machine(machine).vars.remove(0)),
            Op::Changed => tree.machine(machine).vars[0].init.and = 4,
            Op::Renamed => rename(tree, |tree| &mut tree.machine(machine).vars[0].name),
            Op::Reordered => tree.machine(machine).vars.rotate_right(1),
            Op::Moved | Op::MovedOut => {
                let mut var = tree.machine(machine).vars.remove(0);
                var.id = tree.id();
                match (self.op, self.site.inside) {
                    (Op::Moved, _) => tree.machine(self.other_machine()).vars.push(var),
                    (_, Some(outer)) => tree.machine(outer).vars.push(var),
                    (_, None) => tree.vars.push(var),
                }
            }
        }
    }

    fn machine(&self, tree: &mut Tree) {
        let name = self.site.machine;
        if self.op == Op::Added {
            let more = tree.plain("more", None);
            return tree.state(&self.state_name()).machines.push(more);
        }
        if self.op == Op::Renamed {
            return rename(tree, |tree| &mut tree.machine(name).name);
        }
        let beside = tree.beside(name);
        if self.op == Op::Reordered {
            return beside.rotate_left(1);
        }
        let at = beside.iter().position(|machine| machine.name == name).expect("it is there");
        let mut machine = beside.remove(at);
        tree.renew(&mut machine);
        match self.op {
            Op::Moved => {
                let to = format!("{}_off", self.site.inside.unwrap_or(self.other_machine()));
                let to = if name == "dorm" { "main_busy" } else { &to };
                tree.state(to).machines.push(machine);
            }
            Op::MovedOut => {
                let outer = self.site.inside.unwrap_or_default();
                tree.beside(outer).push(machine);
            }
            _ => {}
        }
    }

    fn state(&self, tree: &mut Tree) {
        let (machine, name) = (self.site.machine, self.state_name());
        match self.op {
            Op::Added => {
                let state = tree.plain_state(machine, "new");
                let states = &mut tree.machine(machine).states;
                states.insert(if self.of == Of::Busy { 0 } else { states.len() }, state);
            }
            Op::Changed => {
                let state = tree.state(&name);
                state.onentry.truncate(1);
                state.running = vec![act(&format!("{machine}_a"), Does::Add(100))];
                state.onexit.clear();
            }
            Op::Renamed => rename(tree, |tree| &mut tree.state(&name).name),
            Op::Reordered => {
                let states = &mut tree.machine(machine).states;
                let at = states.iter().position(|state| state.name == name).expect("it is there");
                let state = states.remove(at);
                states.insert(0, state);
            }
            Op::Removed | Op::Moved | Op::MovedOut => {
                let states = &mut tree.machine(machine).states;
                let at = states.iter().position(|state| state.name == name).expect("it is there");
                let mut state = states.remove(at);
                if self.op == Op::Moved {
                    tree.renew_state(&mut state);
                    tree.machine(self.other_machine()).states.push(state);
                }
            }
        }
    }

    fn event(&self, tree: &mut Tree) {
        let machine = self.site.machine;
        match self.op {
            Op::Added => {
                let event = Event { id: tree.id(), name: self.named("new"), when: over(&self.named("a"), 0) };
                tree.machine(machine).events.push(event);
            }
            Op::Removed => tree.machine(machine).events.clear(),
            Op::Changed => tree.machine(machine).events[0].when.limit = 0,
            Op::Renamed => rename(tree, |tree| &mut tree.machine(machine).events[0].name),
            Op::Reordered => tree.machine(machine).events.rotate_left(1),
            Op::Moved | Op::MovedOut => {
                let mut event = tree.machine(machine).events.remove(0);
                event.id = tree.id();
                let to = self.site.inside.filter(|_| self.op == Op::MovedOut).unwrap_or(self.other_machine());
                tree.machine(to).events.push(event);
            }
        }
    }

    fn transition(&self, tree: &mut Tree, on: On) {
        let machine = self.site.machine;
        let due = match on {
            On::Event => Trigger::Event(self.named("e")),
            On::Block => Trigger::Block(over(&self.named("a"), 0)),
            On::Eps => Trigger::Eps,
            On::Ontime => Trigger::After(300),
            On::Exit => Trigger::Exit(over(&self.named("a"), 0)),
        };
        let to = match (on, self.site.inside) {
            (On::Exit, Some(outer)) => format!("{outer}_off"),
            _ => self.named("start"),
        };
        if self.op == Op::Added {
            let new = Transition { trigger: due, from: self.state_name(), to, name: self.named("new") };
            return tree.machine(machine).transitions.insert(0, new);
        }
        let kind = ["event", "block", "eps", "after", "exit"][on as usize];
        let role = if on == On::Eps { "off" } else { self.role() };
        let name = self.named(&format!("{kind}_{role}"));
        let list = &mut tree.machine(machine).transitions;
        let at = list.iter().position(|it| it.name == name).expect("it is there");
        match self.op {
            Op::Changed if on == On::Eps => list[at].from = self.named("busy"),
            Op::Changed if on == On::Event => list[at].to = self.named("start"),
            Op::Changed => list[at].trigger = due,
            Op::Renamed => list[at].name = self.named("other"),
            _ => {
                let mut moved = list.remove(at);
                match self.op {
                    Op::Reordered => list.insert(0, moved),
                    Op::Moved => {
                        let other = self.other_machine();
                        let outer = SITES.iter().find(|site| site.machine == other).and_then(|site| site.inside);
                        let aimed = |name: &str| match (on, name.ends_with("_off"), outer) {
                            (On::Exit, true, Some(outer)) => format!("{outer}_off"),
                            _ => name.replace(machine, other),
                        };
                        (moved.from, moved.to) = (moved.from.replace(machine, other), aimed(&moved.to));
                        tree.machine(other).transitions.insert(0, moved);
                    }
                    _ => {}
                }
            }
        }
    }

    fn action(&self, tree: &mut Tree, when: When) {
        let name = self.state_name();
        let actions = when.of(tree.state(&name));
        match self.op {
            Op::Added => actions.push(act(&self.named("z"), Does::Add(1))),
            Op::Changed => actions[0].does = Does::Add(7),
            Op::Reordered => actions.rotate_left(1),
            _ => {
                let action = actions.remove(0);
                if self.op == Op::Moved {
                    when.of(tree.state(&self.other_state())).push(action);
                }
            }
        }
    }

    fn nested_spawn(&self, tree: &mut Tree) {
        let spawns = &mut tree.state(&self.state_name()).spawns;
        match self.op {
            Op::Added => spawns.push(start("idle")),
            Op::Changed => spawns[0].state = spawns[0].state.replace("start", "off"),
            Op::Reordered => spawns.rotate_left(1),
            _ => {
                let spawn = spawns.remove(0);
                if self.op == Op::Moved {
                    tree.state(&self.other_state()).spawns.push(spawn);
                }
            }
        }
    }

    fn top_spawn(&self, tree: &mut Tree) {
        let at = tree.spawns.iter().position(|top| top.spawn.machine == self.site.machine);
        match (self.op, at) {
            (Op::Changed, Some(at)) => tree.spawns[at].spawn.state = self.named("off"),
            (Op::Reordered, Some(at)) => {
                let top = tree.spawns.remove(at);
                tree.spawns.insert(if at == 0 { tree.spawns.len() } else { 0 }, top);
            }
            (_, Some(at)) => drop(tree.spawns.remove(at)),
            (_, None) => {
                let id = tree.id();
                tree.spawns.insert(0, TopSpawn { id, spawn: start(self.site.machine) });
            }
        }
    }

    fn pause(&self, tree: &mut Tree, which: fn(&mut Tree) -> &mut Option<Action>) {
        match self.op {
            Op::Added => *which(tree) = Some(act("g_solo", Does::Add(3))),
            Op::Changed => *which(tree) = Some(act("g_solo", Does::Add(5))),
            Op::Reordered => tree.upside_down = true,
            _ => *which(tree) = None,
        }
    }
}

impl When {
    fn of(self, state: &mut State) -> &mut Vec<Action> {
        match self {
            When::Entry => &mut state.onentry,
            When::Running => &mut state.running,
            When::Exit => &mut state.onexit,
        }
    }
}

/// Its uses along.
fn rename(tree: &mut Tree, name: impl FnOnce(&mut Tree) -> &mut String) {
    let name = name(tree);
    let old = std::mem::replace(name, format!("new_{name}"));
    let new = format!("new_{old}");
    tree.rename_uses(&old, &new);
}
