//! Reads the backdrops of open plans, and remembers them with the files of the plans.

use std::path::Path;

use super::PlanFiles;
use crate::screen_files::backdrop_file;
use crate::ui::PlanId;
use crate::ui::backdrop::BackdropLayer;
use crate::ui::files::FileReply;

impl PlanFiles {
    /// Puts files under the first plan; none = those remembered with it.
    pub(crate) fn begin_with_backdrop(&mut self, id: PlanId, layers: Vec<BackdropLayer>) -> Vec<FileReply> {
        if layers.is_empty() {
            return self.remembered_backdrop(id);
        }
        let replies = layers.into_iter().map(|layer| self.take_layer(id, layer, false)).collect();
        self.keep_backdrop(id);
        replies
    }

    /// Forgets the files under a plan.
    pub(super) fn forget_backdrop(&mut self, id: PlanId) {
        if let Some(file) = self.open.get_mut(&id) {
            file.backdrop.clear();
        }
        self.keep_backdrop(id);
    }

    /// Reads the files that are remembered with a plan.
    pub(super) fn remembered_backdrop(&mut self, id: PlanId) -> Vec<FileReply> {
        let Some(file) = self.open.get(&id).filter(|file| file.backdrop.is_empty()) else {
            return Vec::new();
        };
        let paths = file.path.as_deref().map_or_else(Vec::new, |path| self.backdrops.of(path));
        // A plan of QGroundControl has its zones in its own file.
        let own = file.path.clone().filter(|path| !paths.contains(path) && backdrop_file::has_fences(path));
        paths.iter().chain(&own).map(|path| self.read_backdrop(id, path, false)).collect()
    }

    /// Reads a file and puts it under a plan.
    pub(super) fn read_backdrop(&mut self, id: PlanId, path: &Path, is_new: bool) -> FileReply {
        let others = self.open.get(&id).map_or(0, |file| {
            file.backdrop.iter().filter(|(other, _)| other != path).map(|(_, vertices)| vertices).sum()
        });
        match backdrop_file::read(path, others) {
            Ok(layer) => {
                let reply = self.take_layer(id, layer, is_new);
                // A remembered file that cannot be read now stays remembered.
                if is_new {
                    self.keep_backdrop(id);
                }
                reply
            }
            Err(error) => FileReply::Failed(format!("{error}.")),
        }
    }

    /// Remembers the files under a plan that has a file.
    pub(super) fn keep_backdrop(&self, id: PlanId) {
        if let Some(file) = self.open.get(&id)
            && let Some(plan) = &file.path
        {
            self.backdrops.keep(plan, file.backdrop.iter().map(|(path, _)| path.clone()).collect());
        }
    }

    fn take_layer(&mut self, id: PlanId, layer: BackdropLayer, is_new: bool) -> FileReply {
        if let Some(file) = self.open.get_mut(&id) {
            file.backdrop.retain(|(path, _)| *path != layer.path);
            file.backdrop.push((layer.path.clone(), layer.vertices()));
        }
        FileReply::Backdrop { id, layer, is_new }
    }
}
