//! A sweep as a table with commas.

use crate::flight::sweep::SweepPoint;

const HEAD: [&str; 9] =
    ["second", "fate", "result", "off_m", "after_s", "north_m", "east_m", "up_m", "reason"];

/// Returns a row for each second.
pub fn sweep_csv(points: &[SweepPoint]) -> Vec<u8> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    // A vector takes everything.
    let _written = writer.write_record(HEAD);
    for point in points {
        let [east, north, up] = point.place_enu.map(|metres| format!("{metres:.3}"));
        let cells = [
            point.second.to_string(),
            point.fate.to_string(),
            point.result.to_string(),
            format!("{:.2}", point.off_m),
            format!("{:.2}", point.after_s),
            north,
            east,
            up,
            point.reason.clone(),
        ];
        let _written = writer.write_record(cells);
    }
    writer.into_inner().unwrap_or_default()
}
