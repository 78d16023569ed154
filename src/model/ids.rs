//! The ids of a program's elements: positions in its arenas, valid for that one program only.

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident,)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u32);

        impl $name {
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}

ids! {
    MachineId,
    StateId,
    TransitionId,
    EventId,
    VarId,
    /// A block of Lua.
    BlockId,
    /// A Lua file.
    ModuleId,
}
