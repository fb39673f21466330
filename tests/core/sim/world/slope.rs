//! Sloping ground: a craft that is at rest, touches down, slides and flies above it.

use betadeck_core::sim::{
    Airframe, Direction, Fault, Surface, Switches, World, WorldCommand, WorldConfig, WorldEventKind,
    ground_effect_factor,
};
use nalgebra::Vector3;

use crate::sim::world::{ideal, run, stand, world};

fn sloping(text: &str) -> WorldConfig {
    let mut switches = Switches::default();
    switches.set(&format!("ground={text}")).expect("a shape of the ground");
    WorldConfig { switches, ..ideal() }
}

fn events(world: &mut World) -> Vec<WorldEventKind> {
    std::iter::from_fn(|| world.take_event()).map(|event| event.kind).collect()
}

fn teleport(world: &mut World, north_east_up: [f64; 3]) {
    world.apply(WorldCommand::FaultOn(Fault::Teleport(north_east_up), None)).expect("a teleport");
}

/// Returns the angle between the craft's up axis and that of the ground, degrees.
fn tilt_on(world: &World, ground: &Surface) -> f64 {
    let truth = world.truth();
    let plane = ground.tangent_at(&truth.pos_enu);
    (truth.attitude * Vector3::z()).angle(plane.normal()).to_degrees()
}

#[test]
fn a_craft_rests_on_a_slope_without_sliding() {
    for (text, airframe) in [
        ("slope,8,90", Airframe::iris()),
        ("slope,20,200", Airframe::iris()),
        ("slope,40,0", Airframe::iris()),
        ("slope,20,315", Airframe::five_inch()),
    ] {
        let config = WorldConfig { airframe, ..sloping(text) };
        let ground = config.switches.ground;
        let mut world = world(config);
        let start = world.truth().pos_enu;
        assert!(start.xy().norm() < 1e-9, "{text}: stands at home");
        let mut farthest: f64 = 0.0;
        stand(&mut world, 30.0, |world| farthest = farthest.max((world.truth().pos_enu - start).norm()));
        let truth = world.truth();
        assert!(farthest < 0.005, "{text}: moved by {farthest} m");
        assert!(truth.vel_enu.norm() < 1e-4 && truth.rate_flu.norm() < 1e-3, "{text}: {truth:?}");
        assert!(tilt_on(&world, &ground) < 0.5, "{text}: {}", tilt_on(&world, &ground));
        assert!(truth.on_ground && !truth.crashed);
        assert!((truth.specific_force_flu.norm() - 9.806_65).abs() < 0.01);
        assert_eq!(events(&mut world), [], "{text}");
    }
}

#[test]
fn a_craft_touches_the_ground_where_the_ground_is() {
    for (text, [north, east], ground_m) in [
        ("slope,8,90", [0.0, 100.0], 8.0),
        ("slope,8,90", [0.0, -100.0], -8.0),
        ("slope,20,0", [50.0, 30.0], 10.0),
        ("slope,20,180", [50.0, 30.0], -10.0),
    ] {
        let config = sloping(text);
        let ground = config.switches.ground;
        let mut world = world(config);
        let standing_m = world.truth().pos_enu.z;
        teleport(&mut world, [north, east, ground_m + 0.1]);
        events(&mut world);
        run(&mut world, 3.0, 0.0);
        let truth = *world.truth();
        let seen = events(&mut world);
        let [WorldEventKind::Contact { impact_mps }, WorldEventKind::Touchdown { .. }] = seen[..] else {
            panic!("{text}: {seen:?}")
        };
        assert!((1.0..1.6).contains(&impact_mps), "{text}: {impact_mps}");
        assert!((truth.ground_m - ground_m).abs() < 0.1, "{text}: {}", truth.ground_m);
        assert!((truth.pos_enu.z - standing_m - ground_m).abs() < 0.05, "{text}: {}", truth.pos_enu.z);
        assert!(truth.on_ground && !truth.crashed, "{text}");
        assert!(tilt_on(&world, &ground) < 0.5, "{text}");
    }
}

#[test]
fn flying_level_into_a_rising_slope_is_a_crash_into_it() {
    let mut world = world(sloping("slope,40,90"));
    teleport(&mut world, [0.0, 0.0, 1.0]);
    world.apply(WorldCommand::FaultOn(Fault::Push(6.0, Direction::East), None)).expect("a push");
    events(&mut world);
    run(&mut world, 2.0, 0.0);
    assert!(world.truth().crashed, "{:?}", world.truth().pos_enu);
}

#[test]
fn wind_and_ground_effect_count_from_the_ground_below() {
    // 10 m above ground that lies 8 m below home: the wind has its full speed, at 2 m above home.
    let config = WorldConfig { wind: "8@0".parse().expect("a wind"), ..sloping("slope,8,90") };
    let mut hill = world(config.clone());
    let mut level = world(WorldConfig { switches: Switches::default(), ..config });
    teleport(&mut hill, [0.0, -100.0, 2.0]);
    teleport(&mut level, [0.0, -100.0, 10.0]);
    run(&mut hill, 0.05, 0.6);
    run(&mut level, 0.05, 0.6);
    let (hill, level) = (hill.truth().wind_enu.norm(), level.truth().wind_enu.norm());
    assert!((hill - level).abs() < 0.01, "{hill} against {level}");

    let force = |text: &str| {
        let mut config = sloping(text);
        config.switches.ground_effect = true;
        let mut world = world(config);
        teleport(&mut world, [0.0, -100.0, -8.0]);
        teleport(&mut world, [0.0, 0.0, 0.05]);
        run(&mut world, 0.05, 0.3);
        world.truth().specific_force_flu.z
    };
    let (near, far) = (force("slope,8,90"), force("slope,20,90"));
    assert!(ground_effect_factor(0.1, 0.25) > 1.0);
    assert!(near > 1.005 * far, "{near} near the ground, {far} 12 m above it");
}

#[test]
fn the_ground_may_change_under_a_craft() {
    let command = |text: &str| WorldCommand::SetSwitch(format!("ground={text}"));
    let mut world = world(ideal());
    stand(&mut world, 1.0, |_| ());
    world.apply(command("slope,20,90")).expect("a switch");
    let ground: Surface = sloping("slope,20,90").switches.ground;
    stand(&mut world, 2.0, |_| ());
    assert!(tilt_on(&world, &ground) < 0.5 && world.truth().on_ground && !world.truth().crashed);
    assert_eq!(events(&mut world), []);
    // In the air the craft stays in its place, unless the ground has risen above it.
    teleport(&mut world, [0.0, 50.0, 30.0]);
    run(&mut world, 0.001, 0.0);
    let before = world.truth().pos_enu;
    world.apply(command("slope,8,90")).expect("a switch");
    run(&mut world, 0.001, 0.0);
    assert!((world.truth().pos_enu - before).norm() < 0.01);
    world.apply(command("flat")).expect("a switch");
    world.apply(WorldCommand::ResetToHome).expect("a reset");
    stand(&mut world, 0.1, |_| ());
    assert!(world.truth().on_ground && tilt_on(&world, &Surface::Flat) < 0.01);
}
