//! Draws the pictures of the documentation and writes them into `docs/`: the screen while the demo plan is flown, the plan
//! editor while one of its altitudes is changed, the flight rewound to an earlier leg, the question before a plan of
//! another program is opened, and a map under the plan.
//!
//! ```sh
//! cargo run --release --example picture
//! ```

use std::error::Error;
use std::path::Path;

mod demo_flight;
mod pictures;
mod svg;

fn main() -> Result<(), Box<dyn Error>> {
    for picture in pictures::pictures()? {
        let file =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(picture.name).with_extension("svg");
        std::fs::write(file, picture.svg)?;
    }
    Ok(())
}
