//! The pictures of the documentation are those of the program of today.

#[path = "../../../examples/picture/demo_flight.rs"]
mod demo_flight;
#[path = "../../../examples/picture/pictures.rs"]
mod drawn;
use super::screens::svg;

#[test]
fn the_pictures_of_the_pages_show_the_screen_of_today() {
    for picture in drawn::pictures().expect("a flight") {
        let file = test_support::path("docs").join(picture.name).with_extension("svg");
        let is_today = std::fs::read_to_string(file).is_ok_and(|text| text == picture.svg);
        assert!(is_today, "docs/{}.svg is old: cargo run --release --example picture", picture.name);
    }
}
