//! A point mass with a lagging tilt, drag, wind and ground, flown by the navigator. Its physics are
//! sufficient to test guidance and control, and run thousands of times faster than real time.

#![allow(dead_code, reason = "each test file uses its own part")]

use betadeck_core::autopilot::control::{
    AltitudeController, AltitudeMeasurement, AltitudeTarget, FlightControllers, PositionController,
    PositionMeasurement, PositionTarget, earth_to_body, throttle_share,
};
use betadeck_core::autopilot::io::{NavInputs, NavOutput};
use betadeck_core::autopilot::land_detector::GroundMeasurement;
use betadeck_core::autopilot::{Navigator, Params};
use betadeck_core::geo::{GRAVITY, LatLon, local_offset, offset_to_latlon};
use betadeck_core::plan::{Altitude, FlightPlan, LegSpeed, Waypoint, WaypointType};
use betadeck_core::signals::{MotorCommand, SimTime};
use betadeck_core::telemetry::{NavEvent, NavState};
use nalgebra::{Vector2, Vector3};

pub(crate) const HOME: LatLon = LatLon::new(404_635_000, -795_182_000);
pub(crate) const DT: f64 = 0.01;

/// The craft and the air around it; north, east, up.
#[derive(Debug, Clone)]
pub(crate) struct Plant {
    pub(crate) pos: Vector2<f64>,
    pub(crate) vel: Vector2<f64>,
    pub(crate) alt: f64,
    pub(crate) climb: f64,
    pub(crate) heading: f64,
    pub(crate) yaw_rate: f64,
    /// The tilt (forward, right), rad.
    pub(crate) tilt: Vector2<f64>,
    pub(crate) accel: Vector2<f64>,
    /// The ratio of thrust to weight.
    pub(crate) thrust: f64,
    /// The throttle at which the craft hovers, µs.
    pub(crate) hover_us: f64,
    /// The bandwidth of the tilt, rad/s.
    pub(crate) tilt_bandwidth: f64,
    /// The mean wind, towards (north, east), m/s.
    pub(crate) wind: Vector2<f64>,
    /// The standard deviation of the gusts, m/s.
    pub(crate) gust_sd: f64,
    gust: Vector2<f64>,
    seed: u64,
    pub(crate) impact_mps: Option<f64>,
}

impl Plant {
    pub(crate) fn new(alt: f64) -> Self {
        Self {
            pos: Vector2::zeros(),
            vel: Vector2::zeros(),
            alt,
            climb: 0.0,
            heading: 0.0,
            yaw_rate: 0.0,
            tilt: Vector2::zeros(),
            accel: Vector2::zeros(),
            thrust: 1.0,
            hover_us: 1500.0,
            tilt_bandwidth: 5.0,
            wind: Vector2::zeros(),
            gust_sd: 0.0,
            gust: Vector2::zeros(),
            seed: 1,
            impact_mps: None,
        }
    }

    fn normal(&mut self) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            self.seed =
                self.seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            sum += (self.seed >> 11) as f64 / (1_u64 << 53) as f64;
        }
        sum
    }

    /// Advances the craft by one step of `DT`. `throttle` is the mixer's share, 0…1.
    pub(crate) fn step(&mut self, roll: f64, pitch: f64, yaw_rate: f64, throttle: f64) {
        let share = throttle / ((self.hover_us - 1050.0) / 950.0);
        self.thrust += (share * share - self.thrust) * DT / 0.05;
        self.tilt += (Vector2::new(pitch, roll) - self.tilt) * (self.tilt_bandwidth * DT);
        self.yaw_rate += (yaw_rate - self.yaw_rate) * (8.0 * DT);
        self.heading = (self.heading + self.yaw_rate * DT).rem_euclid(std::f64::consts::TAU);
        // A gust with a correlation time of 2 s.
        let tau = 2.0;
        let kick = self.gust_sd * (2.0 * DT / tau).sqrt();
        let noise = Vector2::new(self.normal(), self.normal());
        self.gust += -self.gust * (DT / tau) + noise * kick;
        let air = self.vel - self.wind - self.gust;
        let drag = -air * (0.19 + 0.0145 * air.norm());
        let tilt = self.tilt.norm();
        let thrust = self.thrust * GRAVITY;
        let tilt_ne = earth_to_body(self.tilt, -self.heading);
        let push = tilt_ne.try_normalize(1e-9).unwrap_or_default() * (thrust * tilt.sin());
        self.accel = push + drag;
        let mut lift = thrust * tilt.cos() - GRAVITY - 0.2 * self.climb;
        if self.alt <= 0.0 {
            if self.climb < 0.0 {
                self.impact_mps.get_or_insert(-self.climb);
                self.climb = 0.0;
            }
            self.alt = 0.0;
            if lift < 0.0 {
                lift = 0.0;
                self.accel = Vector2::zeros();
                self.vel *= 0.9;
            }
        }
        self.vel += self.accel * DT;
        self.pos += self.vel * DT;
        self.climb += lift * DT;
        self.alt += self.climb * DT;
    }
}

/// One update of the log.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    pub(crate) t: f64,
    pub(crate) state: NavState,
    pub(crate) wp: u8,
    pub(crate) pos: Vector2<f64>,
    pub(crate) vel: Vector2<f64>,
    pub(crate) alt: f64,
    pub(crate) climb: f64,
    pub(crate) tilt_deg: f64,
    pub(crate) demand_deg: f64,
    pub(crate) throttle_us: f64,
    pub(crate) heading: f64,
    pub(crate) xte: Option<f64>,
    pub(crate) target: Vector2<f64>,
    pub(crate) out: NavOutput,
    pub(crate) stands: bool,
}

/// A flight: craft, navigator, plan and log. Time counts from engagement.
#[derive(Debug, Clone)]
pub(crate) struct Flight {
    pub(crate) plant: Plant,
    pub(crate) nav: Navigator,
    pub(crate) controllers: FlightControllers,
    pub(crate) params: Params,
    pub(crate) plan: FlightPlan,
    pub(crate) inputs: NavInputs,
    pub(crate) log: Vec<Sample>,
    pub(crate) events: Vec<(f64, NavEvent)>,
    pub(crate) disarmed: bool,
    ticks: u64,
    engaged_at: u64,
}

pub(crate) fn inputs() -> NavInputs {
    NavInputs {
        time: SimTime(10_000_000),
        dt: DT,
        armed: true,
        fix: true,
        altitude_valid: true,
        heading_valid: true,
        throttle_raised: true,
        home: Some(HOME),
        origin: HOME,
        alt_m: 20.0,
        throttle_us: 1500.0,
        ..NavInputs::unknown()
    }
}

/// Sets a parameter within its range.
pub(crate) fn set(params: &mut Params, name: &str, value: i64) {
    let field = Params::field(name).unwrap();
    assert!((field.min..=field.max).contains(&value), "{name} = {value}");
    (field.set)(params, value);
}

/// Returns the parameters of the guide's configuration block.
pub(crate) fn guide() -> Params {
    let mut params = Params::default();
    for (name, value) in [
        ("ap_position_p", 40),
        ("ap_position_i", 10),
        ("ap_position_d", 30),
        ("ap_position_a", 20),
        ("ap_position_cutoff", 5),
        ("ap_altitude_p", 50),
        ("ap_altitude_i", 30),
        ("ap_altitude_d", 20),
        ("ap_altitude_f", 10),
        ("ap_hover_throttle", 1500),
        ("ap_waypoint_arrival_radius", 500),
        ("ap_waypoint_hold_radius", 200),
        ("ap_max_angle", 25),
        ("ap_l1_period", 20),
        ("ap_l1_min_lookahead", 1000),
        ("ap_l1_max_lookahead", 10000),
        ("ap_landing_descent_rate", 50),
        ("ap_landing_detection_time", 10),
        ("ap_landing_velocity_threshold", 50),
        ("ap_max_yaw_rate", 90),
        ("ap_max_distance_from_home", 500),
    ] {
        set(&mut params, name, value);
    }
    params
}

/// Returns a waypoint at metres north and east of home.
pub(crate) fn waypoint(kind: WaypointType, north: f64, east: f64, alt_m: f64, speed_mps: f64) -> Waypoint {
    Waypoint {
        position: offset_to_latlon(HOME, Vector2::new(north, east)),
        altitude: Altitude::above_home(alt_m),
        speed: LegSpeed::from_mps(speed_mps),
        kind,
        ..Waypoint::default()
    }
}

pub(crate) fn plan(waypoints: &[Waypoint]) -> FlightPlan {
    FlightPlan { waypoints: waypoints.iter().copied().collect() }
}

impl Flight {
    pub(crate) fn new(params: Params, waypoints: &[Waypoint], alt: f64) -> Self {
        Self {
            plant: Plant::new(alt),
            nav: Navigator::new(),
            controllers: FlightControllers::default(),
            params,
            plan: plan(waypoints),
            inputs: inputs(),
            log: Vec::new(),
            events: Vec::new(),
            disarmed: false,
            ticks: 1000,
            engaged_at: 1000,
        }
    }

    pub(crate) fn wind(mut self, towards_north: f64, towards_east: f64, gust_sd: f64) -> Self {
        self.plant.wind = Vector2::new(towards_north, towards_east);
        self.plant.gust_sd = gust_sd;
        self
    }

    /// Returns the seconds since engagement.
    pub(crate) fn t(&self) -> f64 {
        (self.ticks - self.engaged_at) as f64 * DT
    }

    fn sense(&mut self) {
        self.ticks += 1;
        let plant = &self.plant;
        self.inputs.time = SimTime(self.ticks * 10_000);
        self.inputs.pos_ne = plant.pos;
        self.inputs.vel_ne = plant.vel;
        self.inputs.alt_m = plant.alt;
        self.inputs.climb_mps = plant.climb;
        self.inputs.heading_rad = plant.heading;
        self.inputs.yaw_rate_rps = plant.yaw_rate;
        self.inputs.roll_rad = plant.tilt.y;
        self.inputs.pitch_down_rad = plant.tilt.x;
        self.inputs.cos_tilt = plant.tilt.norm().cos();
        self.inputs.accel_ne = plant.accel;
        let on_legs = if plant.alt <= 0.0 { (1.0 - plant.thrust).max(0.0) } else { 0.0 };
        let force = Vector3::new(0.0, 0.0, (plant.thrust + on_legs) * GRAVITY);
        let motor = (self.inputs.throttle_us - 1050.0) / 950.0;
        let ground =
            GroundMeasurement::new(&self.inputs, force, plant.yaw_rate.abs(), &MotorCommand([motor; 4]));
        self.controllers.land.observe(&ground, true, DT);
    }

    /// Flies the pilot's altitude and position hold for some seconds, with the shared controllers.
    pub(crate) fn hover(&mut self, seconds: f64) {
        let (mut altitude, mut position) = (AltitudeController::default(), PositionController::default());
        // The pilot has a good tune, whatever parameters the flight under test uses.
        let params = Params { hover_throttle: self.plant.hover_us as u16, ..guide() };
        self.inputs.throttle_us = self.plant.hover_us;
        let (point, height) = (self.plant.pos, self.plant.alt);
        for tick in 0..(seconds / DT) as u32 {
            self.sense();
            let vertical = vertical(&self.inputs);
            let horizontal = horizontal(&self.inputs);
            if tick == 0 {
                altitude.engage(&vertical, &params);
                position.engage(&horizontal);
            }
            self.nav.update(&self.inputs, &self.params, &self.plan, &mut self.controllers);
            self.controllers.track_altitude(&self.inputs, &self.params);
            self.controllers.track_position(&self.inputs);
            let throttle = altitude.update(&vertical, AltitudeTarget::Altitude(height), &params, DT);
            let tilt = position.update(&horizontal, &PositionTarget::stay(point, &params), &params, DT);
            let body = earth_to_body(tilt, self.plant.heading);
            self.plant.step(body.y, body.x, 0.0, throttle_share(throttle, &params));
            self.inputs.throttle_us = throttle;
        }
    }

    pub(crate) fn engage(&mut self) {
        self.sense();
        self.engaged_at = self.ticks;
        self.nav.engage(&self.inputs, &self.params, &self.plan).unwrap();
    }

    /// Hovers for 5 s and engages.
    pub(crate) fn launch(mut self) -> Self {
        self.hover(5.0);
        self.engage();
        self
    }

    pub(crate) fn tick(&mut self) {
        self.sense();
        let mut out = self.nav.update(&self.inputs, &self.params, &self.plan, &mut self.controllers);
        // As in the firmware, a landed craft is not tilted on its legs.
        let share = self.controllers.land.tilt_share();
        (out.roll_rad, out.pitch_down_rad) = (share * out.roll_rad, share * out.pitch_down_rad);
        let t = self.t();
        while let Some(event) = self.nav.take_event() {
            if event == NavEvent::Disarm {
                self.disarmed = true;
            }
            self.events.push((t, event));
        }
        let throttle = if self.disarmed { 1000.0 } else { out.throttle_us };
        let telemetry = self.nav.telemetry();
        self.log.push(Sample {
            t,
            state: telemetry.state,
            wp: telemetry.wp,
            pos: self.plant.pos,
            vel: self.plant.vel,
            alt: self.plant.alt,
            climb: self.plant.climb,
            tilt_deg: self.plant.tilt.norm().to_degrees(),
            demand_deg: out.roll_rad.hypot(out.pitch_down_rad).to_degrees(),
            throttle_us: throttle,
            heading: self.plant.heading,
            xte: telemetry.xte_m,
            target: telemetry.target_ne.unwrap_or_default(),
            out,
            stands: self.controllers.land.stands(),
        });
        let share = if self.disarmed { 0.0 } else { out.throttle };
        self.plant.step(out.roll_rad, out.pitch_down_rad, out.yaw_rate_rps.unwrap_or(0.0), share);
        self.inputs.throttle_us = throttle;
    }

    pub(crate) fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds / DT).round() as u32 {
            self.tick();
        }
    }

    /// Runs until `done` or for `limit` seconds. Returns `true` if `done` was reached.
    pub(crate) fn until(&mut self, limit: f64, done: impl Fn(&Self) -> bool) -> bool {
        let end = self.t() + limit;
        while self.t() < end {
            self.tick();
            if done(self) {
                return true;
            }
        }
        false
    }

    pub(crate) fn since(&self, t: f64) -> impl Iterator<Item = &Sample> {
        self.log.iter().filter(move |sample| sample.t >= t)
    }

    /// Returns the (state, waypoint) of every state event, in order.
    pub(crate) fn sequence(&self) -> Vec<(NavState, u8)> {
        let mut list: Vec<(NavState, u8)> = Vec::new();
        for (_, event) in &self.events {
            if let NavEvent::State { to, wp, .. } = event {
                list.push((*to, *wp));
            }
        }
        list
    }

    /// Returns the time at which `state` was entered at waypoint `wp`.
    pub(crate) fn entered(&self, state: NavState, wp: u8) -> Option<f64> {
        self.events.iter().find_map(|(t, event)| match event {
            NavEvent::State { to, wp: at, .. } if *to == state && *at == wp => Some(*t),
            _ => None,
        })
    }

    pub(crate) fn place(&self, index: usize) -> Vector2<f64> {
        local_offset(HOME, self.plan.waypoints[index].position)
    }
}

pub(crate) fn vertical(inputs: &NavInputs) -> AltitudeMeasurement {
    AltitudeMeasurement {
        altitude_m: inputs.alt_m,
        climb_mps: inputs.climb_mps,
        cos_tilt: inputs.cos_tilt,
        throttle_us: inputs.throttle_us,
    }
}

pub(crate) fn horizontal(inputs: &NavInputs) -> PositionMeasurement {
    PositionMeasurement {
        position: inputs.pos_ne,
        velocity: inputs.vel_ne,
        accel: inputs.accel_ne,
        tilt_body: Vector2::new(inputs.pitch_down_rad, inputs.roll_rad),
        heading_rad: inputs.heading_rad,
    }
}

/// Returns the root mean square.
pub(crate) fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value * value, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

/// Returns the greatest of finite values.
pub(crate) fn worst(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, f64::max)
}
