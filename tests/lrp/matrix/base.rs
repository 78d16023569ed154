//! The program that every cell of the matrix begins with. Each of its machines is built alike: `M_start` goes to
//! `M_busy`, which is active when the edit comes, and `M_off` back to `M_start`.

use super::tree::*;

/// A machine to edit, and how it stands to the innermost active one when the edit comes.
#[derive(Clone, Copy)]
pub struct Site {
    pub machine: &'static str,
    pub at: &'static str,
    /// The machine that the state it is written in belongs to; none: it stands at top level.
    pub inside: Option<&'static str>,
}

const fn site(machine: &'static str, at: &'static str, inside: Option<&'static str>) -> Site {
    Site { machine, at, inside }
}

pub const SITES: &[Site] = &[
    site("solo", "active", None),
    site("inner", "active", Some("mid")),
    site("main", "ancestor of the active one", None),
    site("mid", "ancestor of the active one", Some("main")),
    site("side", "concurrent sibling", None),
    site("twin", "concurrent sibling", Some("main")),
    site("nest", "nested in a concurrent sibling", Some("side")),
    site("lent", "run by a concurrent sibling", None),
    site("idle", "inactive", None),
    site("dorm", "inactive", Some("main")),
];

/// When a machine leaves `M_busy` by itself, ms after it has entered it.
fn patience(machine: &str) -> i64 {
    match machine {
        "inner" => 800,
        "mid" => 1200,
        "main" => 1600,
        "side" => 1400,
        _ => 1000,
    }
}

pub fn program() -> Tree {
    let mut tree = Tree::default();
    tree.bridges.push(Bridge { name: "robot".into(), config: "stale = 500".into() });
    let inner = tree.plain("inner", None);
    let mid = tree.plain("mid", Some(inner));
    let mut main = tree.plain("main", Some(mid));
    let twin = tree.plain("twin", None);
    main.states[1].hold(twin);
    let dorm = tree.plain("dorm", None);
    main.states[2].hold(dorm);
    let nest = tree.plain("nest", None);
    let mut side = tree.plain("side", Some(nest));
    side.states[1].spawns.push(start("lent"));
    tree.machines.extend([main, side]);
    for name in ["solo", "lent", "idle"] {
        let machine = tree.plain(name, None);
        tree.machines.push(machine);
    }
    for name in ["main", "side", "solo"] {
        let id = tree.id();
        tree.spawns.push(TopSpawn { id, spawn: start(name) });
    }
    tree.onpause = Some(act("g_solo", Does::Add(1)));
    tree.onresume = Some(act("g_solo", Does::Double));
    tree
}

pub fn start(machine: &str) -> Spawn {
    Spawn { machine: machine.into(), state: format!("{machine}_start") }
}

pub fn act(var: &str, does: Does) -> Action {
    Action { var: var.into(), does }
}

impl State {
    fn hold(&mut self, machine: Machine) {
        self.spawns.push(start(&machine.name));
        self.machines.push(machine);
    }
}

pub fn over(var: &str, limit: i64) -> Over {
    Over { var: var.into(), limit }
}

impl Tree {
    pub fn var(&mut self, name: String, of: &[&str], and: i64) -> Var {
        Var { id: self.id(), name, init: Sum { of: of.iter().map(|&name| name.into()).collect(), and } }
    }

    pub fn plain_state(&mut self, machine: &str, name: &str) -> State {
        let (a, g) = (&*format!("{machine}_a"), &*format!("g_{machine}"));
        let both = |var: &str, n| vec![act(var, Does::Add(n)), act(var, Does::Double)];
        State {
            id: self.id(),
            name: format!("{machine}_{name}"),
            onentry: both(a, 1),
            spawns: Vec::new(),
            running: both(a, 3),
            onexit: both(g, 1),
            machines: Vec::new(),
        }
    }

    /// A machine built as all are, and its global; `nested` runs in its busy state.
    pub fn plain(&mut self, name: &str, nested: Option<Machine>) -> Machine {
        let named = |role: &str| format!("{name}_{role}");
        let global = self.var(format!("g_{name}"), &[], 10);
        self.vars.push(global);
        let vars = vec![
            self.var(named("a"), &[], 1),
            self.var(named("b"), &[&named("a"), &format!("g_{name}")], 5),
            self.var(named("z"), &[], 9),
        ];
        let event = Event { id: self.id(), name: named("e"), when: over(&named("a"), NEVER) };
        let mut states: Vec<State> = ["start", "busy", "off"].map(|state| self.plain_state(name, state)).into();
        (states[0].onentry, states[0].running, states[0].onexit) = Default::default();
        if let Some(nested) = nested {
            states[1].hold(nested);
        }
        let go =
            Transition { trigger: Trigger::After(200), from: named("start"), to: named("busy"), name: named("go") };
        let mut transitions = vec![go];
        for (from, to) in [("busy", "off"), ("off", "start")] {
            for (kind, trigger) in [
                ("event", Trigger::Event(named("e"))),
                ("block", Trigger::Block(over(&named("a"), NEVER + 1))),
                ("after", Trigger::After(if from == "busy" { patience(name) } else { 700 })),
            ] {
                let name = named(&format!("{kind}_{from}"));
                transitions.push(Transition { trigger, from: named(from), to: named(to), name });
            }
        }
        let back = Transition { trigger: Trigger::Eps, from: named("off"), to: named("start"), name: named("eps_off") };
        transitions.push(back);
        if let Some(outer) = SITES.iter().find(|site| site.machine == name).and_then(|site| site.inside) {
            for from in ["busy", "off"] {
                let (trigger, name) = (Trigger::Exit(over(&named("a"), NEVER + 2)), named(&format!("exit_{from}")));
                transitions.push(Transition { trigger, from: named(from), to: format!("{outer}_off"), name });
            }
        }
        Machine { id: self.id(), name: name.into(), vars, events: vec![event], states, transitions }
    }
}
