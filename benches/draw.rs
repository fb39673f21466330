//! Time of a frame.

use betadeck::ui::draw;
use divan::Bencher;
use ratatui::Terminal;
use ratatui::backend::TestBackend;

#[path = "../tests/ui/fixture.rs"]
mod fixture;

fn main() {
    divan::main();
}

/// A whole frame: draw and compare with the frame before.
#[divan::bench(args = [(80, 24), (120, 40), (200, 60)])]
fn frame(bencher: Bencher<'_, '_>, size: (u16, u16)) {
    let mut state = fixture::state(size, fixture::colour());
    fixture::orbit(&mut state);
    let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).expect("a test terminal");
    bencher.bench_local(|| terminal.draw(|frame| draw(&state, frame)).map(|_| ()));
}
