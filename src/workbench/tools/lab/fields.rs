//! How a textile is called that is kept: what is typed, and what is wrong with it.

use serde::{Deserialize, Serialize};

use selvedge_textile::id_of;

/// What is typed.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct KeepFields {
    /// What people call it.
    pub name: String,
    /// What scenes call it: the name of its folder.
    pub id: String,
    /// One line of description.
    pub notes: String,
    /// Whether the id was typed, and no longer follows the name.
    pub(crate) has_own_id: bool,
}

impl KeepFields {
    /// For a recipe of this name, or a copy of it.
    pub(crate) fn of(name: &str, is_copy: bool) -> Self {
        let name = if is_copy {
            format!("{name}, changed")
        } else {
            name.to_owned()
        };
        let mut fields = Self {
            name,
            ..Self::default()
        };
        fields.follow_name();
        fields
    }

    /// The id follows the name until it is typed.
    pub(crate) fn follow_name(&mut self) {
        if !self.has_own_id {
            self.id = id_of(&self.name);
        }
    }

    /// Why no textile can be kept under this name and id.
    pub(crate) fn refusal(&self) -> Option<String> {
        let id = self.id.trim();
        if self.name.trim().is_empty() {
            return Some("The name is empty; give the textile a name".to_owned());
        }
        let words = "write it with letters a to z, digits and single hyphens";
        let is_wrong = id.is_empty() || id_of(id) != id;
        is_wrong.then(|| format!("The id \"{id}\" can be no folder's name; {words}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_follows_the_name_until_it_is_typed() {
        let mut fields = KeepFields::of("Wool twill", true);
        assert_eq!(fields.id, "wool-twill-changed");
        fields.name = "Köper  Nr. 3 ".to_owned();
        fields.follow_name();
        assert_eq!(fields.id, "koper-nr-3");
        fields.id = "mine".to_owned();
        fields.has_own_id = true;
        fields.name = "Other".to_owned();
        fields.follow_name();
        assert_eq!(fields.id, "mine");
    }

    #[test]
    fn an_id_that_can_be_no_folder_is_refused_in_a_line() {
        let with = |name: &str, id: &str| KeepFields {
            name: name.to_owned(),
            id: id.to_owned(),
            ..KeepFields::default()
        };
        assert_eq!(with("a", "a-1").refusal(), None);
        for (name, id) in [(" ", "a"), ("a", ""), ("a", "../a"), ("a", "Wool-Twill")] {
            let words = with(name, id).refusal().unwrap();
            assert!(words.contains(';') && !words.contains('\n'), "{words}");
        }
    }
}
