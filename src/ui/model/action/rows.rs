//! The form in which the actions are written.

/// Makes an enum with a variant for each row, and a list of the rows of each group. A row has the context of its keys,
/// a stable name, a title, a help and the keys.
macro_rules! actions {
    ($(#[$meta:meta])* $name:ident { $($other:tt)* }
        $($group:ident { $($action:ident $context:ident $id:literal $title:literal $help:literal [$($key:literal),+];)* })*
    ) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $name {
            $($(#[doc = $help] $action,)*)*
            $($other)*
        }

        $(pub(super) const $group: &[crate::ui::model::action::Spec<$name>] = &[$(crate::ui::model::action::Spec {
            action: $name::$action,
            name: $id,
            title: $title,
            help: $help,
            keys: &[$($key),+],
            context: $context,
        }),*];)*
    };
}
pub(super) use actions;
