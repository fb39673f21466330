//! The ground of elevation tiles: a craft that is at rest, touches down and flies above it.

use std::sync::Arc;

use betadeck_core::geo::{LatLon, LocalFrame};
use betadeck_core::sim::{Fault, Switches, World, WorldCommand, WorldConfig, WorldError, WorldEventKind};
use betadeck_core::terrain::{Grid, Samples, Square, Tiles};
use nalgebra::Vector3;

use crate::sim::world::{ideal, run, stand, world};

const SIDE: usize = 1201;

/// Returns a tile around the default home whose ground is 200 m above sea level in the west and rises by 20 m from
/// each column to the next, which is 70.7 m east of it: 28 m in 100 m.
fn tiles() -> Arc<Tiles> {
    let mut metres = Vec::with_capacity(SIDE * SIDE);
    for _ in 0..SIDE {
        metres.extend((0..SIDE).map(|col| (200 + 20 * col) as f32));
    }
    let step_deg = 1.0 / 1200.0;
    let grid = Grid {
        rows: SIDE,
        cols: SIDE,
        north_deg: 41.0,
        west_deg: -80.0,
        lat_step_deg: step_deg,
        lon_step_deg: step_deg,
        samples: Samples::Floats(metres),
    };
    let mut tiles = Tiles::default();
    tiles.insert(Square { lat_deg: 40, lon_deg: -80 }, grid);
    Arc::new(tiles)
}

fn hilly() -> WorldConfig {
    let mut switches = Switches::default();
    switches.set("ground=terrain").expect("a shape of the ground");
    WorldConfig { switches, terrain: Some(tiles()), ..ideal() }
}

fn events(world: &mut World) -> Vec<WorldEventKind> {
    std::iter::from_fn(|| world.take_event()).map(|event| event.kind).collect()
}

fn teleport(world: &mut World, north_east_up: [f64; 3]) {
    world.apply(WorldCommand::FaultOn(Fault::Teleport(north_east_up), None)).expect("a teleport");
}

/// Returns T(p) − T(home) at a place east and north of home, m.
fn ground_m(config: &WorldConfig, [north, east]: [f64; 2]) -> f64 {
    let home = config.home;
    let frame = LocalFrame::new(home.lat_deg, home.lon_deg, home.alt_amsl_m);
    let tiles = config.terrain.as_ref().expect("tiles");
    let (lat_deg, lon_deg, _) = frame.to_geodetic(Vector3::new(east, north, 0.0));
    let at = |lat, lon| tiles.elevation(LatLon::from_degrees(lat, lon)).expect("a height");
    at(lat_deg, lon_deg) - at(home.lat_deg, home.lon_deg)
}

#[test]
fn a_craft_lands_on_a_slope_at_the_height_of_the_ground_there() {
    for place in [[0.0, 100.0], [30.0, -100.0], [-200.0, 333.0]] {
        let config = hilly();
        let expected_m = ground_m(&config, place);
        let mut world = world(config);
        let standing_m = world.truth().pos_enu.z;
        teleport(&mut world, [place[0], place[1], expected_m + 0.1]);
        events(&mut world);
        run(&mut world, 3.0, 0.0);
        let truth = *world.truth();
        let seen = events(&mut world);
        assert!(
            matches!(seen[..], [WorldEventKind::Contact { .. }, WorldEventKind::Touchdown { .. }]),
            "{place:?}: {seen:?}"
        );
        assert!(
            (truth.ground_m - expected_m).abs() < 0.1,
            "{} at {place:?}, not {expected_m}",
            truth.ground_m
        );
        assert!((truth.pos_enu.z - standing_m - expected_m).abs() < 0.05, "{place:?}: {}", truth.pos_enu.z);
        assert!(truth.on_ground && !truth.crashed && expected_m.abs() > 27.0, "{place:?}");
    }
}

#[test]
fn home_is_at_height_zero_whatever_the_tiles_say() {
    let mut world = world(hilly());
    let start = world.truth().pos_enu;
    assert!(start.xy().norm() < 1e-9 && (0.1..0.3).contains(&start.z), "{start:?}");
    stand(&mut world, 10.0, |_| ());
    let truth = world.truth();
    assert!((truth.pos_enu - start).norm() < 0.005 && truth.on_ground && truth.ground_m.abs() < 0.01);
}

#[test]
fn a_clone_shares_the_tiles_and_flies_the_same() {
    let mut one = world(hilly());
    teleport(&mut one, [0.0, 50.0, 40.0]);
    let mut other = one.clone();
    run(&mut one, 2.0, 0.4);
    run(&mut other, 2.0, 0.4);
    assert_eq!(one.truth().pos_enu, other.truth().pos_enu);
}

#[test]
fn without_a_tile_at_home_there_is_no_terrain() {
    let refused = World::new(WorldConfig { terrain: None, ..hilly() });
    assert_eq!(refused.err(), Some(WorldError::NoTerrain));
    let mut level = world(WorldConfig { terrain: Some(tiles()), ..ideal() });
    let command = || WorldCommand::SetSwitch("ground=terrain".to_owned());
    level.apply(command()).expect("the tiles are there");
    run(&mut level, 0.5, 0.0);
    assert!(level.truth().on_ground && !level.truth().crashed);
    let mut without = world(ideal());
    assert_eq!(without.apply(command()), Err(WorldError::NoTerrain));
    assert!(without.status().switches.changed().is_empty(), "nothing has changed");
}
