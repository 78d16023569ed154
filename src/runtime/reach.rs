//! Which variables can change without being named: through a table or a function that another variable holds as well.

use crate::model::{Owner, Program, VarId};

/// Variables that are one group.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Group(usize);

/// Variables that meet in some block may share a table or hold a function that changes the others, so what changes one
/// may change them all: they are one group.
#[derive(Default)]
pub(super) struct Reach {
    /// By variable: which group.
    group: Vec<usize>,
    groups: Vec<Vec<VarId>>,
}

impl Reach {
    pub fn of(program: &Program) -> Reach {
        let mut group: Vec<usize> = (0..program.vars.len()).collect();
        let mut groups: Vec<Vec<VarId>> = (0..program.vars.len()).map(|index| vec![VarId(index as u32)]).collect();
        for block in &program.blocks {
            let given = match block.owner {
                Owner::Var(var) => Some(var),
                _ => None,
            };
            let mut met = given.iter().chain(&block.uses);
            let Some(first) = met.next() else { continue };
            for other in met {
                let (into, from) = (group[first.index()], group[other.index()]);
                if into != from {
                    let joined = std::mem::take(&mut groups[from]);
                    joined.iter().for_each(|var| group[var.index()] = into);
                    groups[into].extend(joined);
                }
            }
        }
        Reach { group, groups }
    }

    /// The groups that these variables belong to, each once.
    pub fn groups_of(&self, uses: impl Iterator<Item = VarId>, groups: &mut Vec<Group>) {
        groups.extend(uses.map(|var| Group(self.group[var.index()])));
        groups.sort_unstable();
        groups.dedup();
    }

    /// All variables that may change when a block uses one of them.
    pub fn vars(&self, group: Group) -> &[VarId] {
        &self.groups[group.0]
    }
}
