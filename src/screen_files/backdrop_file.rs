//! Reads the files of a backdrop.

use std::path::{Path, PathBuf};

use crate::files::input_file;
use crate::plan::feature::Feature;
use crate::plan::format::{self, Format};
use crate::process::error::AppError;
use crate::ui::backdrop::{BackdropLayer, MAX_VERTICES};

/// Reads the shapes of a file.
pub(crate) fn read_features(path: &Path) -> Result<Vec<Feature>, AppError> {
    let name = path.display().to_string();
    let bytes = input_file::read_map(path)?;
    format::read_features(&name, &bytes).map_err(|errors| {
        AppError::input(match errors.first() {
            Some(first) => first.headline(),
            None => format!("{name} is not a map"),
        })
    })
}

/// Returns `true` for a plan of QGroundControl that has zones.
pub(crate) fn has_fences(path: &Path) -> bool {
    Format::from_file_name(&path.to_string_lossy()) == Some(Format::QgcPlan)
        && read_features(path).is_ok_and(|features| !features.is_empty())
}

/// Reads a file for the screen, for a backdrop that has some vertices already.
pub(crate) fn read(path: &Path, vertices: usize) -> Result<BackdropLayer, AppError> {
    let features = read_features(path)?;
    let name = path.display();
    if features.is_empty() {
        return Err(AppError::input(format!("{name} has no points, lines or areas")));
    }
    let layer = BackdropLayer::new(path.to_owned(), features);
    if vertices + layer.vertices() > MAX_VERTICES {
        let others = if vertices > 0 {
            format!(", with the other files {}", vertices + layer.vertices())
        } else {
            String::new()
        };
        return Err(AppError::input(format!(
            "{name} has {} vertices{others}; a backdrop has at most {MAX_VERTICES}: simplify it or cut it to the area of the flight",
            layer.vertices()
        )));
    }
    Ok(layer)
}

/// Reads the files of the command line.
pub(crate) fn read_all(paths: &[PathBuf]) -> Result<Vec<BackdropLayer>, AppError> {
    let mut layers: Vec<BackdropLayer> = Vec::new();
    for path in paths {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.clone());
        let before = layers.iter().map(BackdropLayer::vertices).sum();
        layers.push(read(&path, before)?);
    }
    Ok(layers)
}
