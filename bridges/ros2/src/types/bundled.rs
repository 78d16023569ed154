//! The common interfaces of ROS 2, for boards without ROS. `interfaces/make` gathers them; `interfaces/LICENSES.md` says
//! whose they are.

/// Each definition follows a line with its name.
const INTERFACES: &str = include_str!("../../interfaces/interfaces.txt");

const MARK: &str = "=== ";

/// The text of a message, service or action by its name, as `std_srvs/srv/Trigger`.
pub fn definition(name: &str) -> Option<&'static str> {
    all().find(|(known, _)| *known == name).map(|(_, text)| text)
}

/// Names with their definitions.
pub fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    INTERFACES.split(MARK).filter_map(|part| part.split_once('\n'))
}
