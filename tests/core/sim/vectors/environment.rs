//! Air, earth, magnetic field, turbulence scales and gusts.

use betadeck_core::geo::LocalFrame;
use betadeck_core::sim::{
    DrydenScales, SITL_DECLINATION_DEG, density, magnetic_field_enu, one_minus_cosine, pressure_pa,
    temperature_k,
};
use betadeck_core::telemetry::Turbulence;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::sim::vectors::{close, near, num, rows, section, vec3};

#[test]
fn standard_atmosphere() {
    for row in rows(&section("environment")["isa"]) {
        let h = num(&row["h"]);
        near(temperature_k(h), num(&row["T_K"]), 1e-12);
        near(pressure_pa(h), num(&row["p_Pa"]), 1e-9);
        near(density(h), num(&row["rho"]), 1e-9);
        // Betaflight's SITL computes the same from the altitude, to its resolution of 1 Pa.
        close(pressure_pa(h), num(&row["sitl_formula_Pa"]), 0.01);
        assert_eq!(pressure_pa(h).trunc(), num(&row["sitl_int_Pa"]));
    }
}

/// Returns latitude, longitude and altitude of a point of the tangent plane, exactly on the ellipsoid (Bowring's
/// iteration).
fn exact_geodetic(home: Vector3<f64>, enu: Vector3<f64>) -> Vector3<f64> {
    const A: f64 = 6_378_137.0;
    const F: f64 = 1.0 / 298.257_223_563;
    const E2: f64 = F * (2.0 - F);
    let (sin_lat, cos_lat) = home.x.to_radians().sin_cos();
    let (sin_lon, cos_lon) = home.y.to_radians().sin_cos();
    let n = A / (1.0 - E2 * sin_lat * sin_lat).sqrt();
    let east = Vector3::new(-sin_lon, cos_lon, 0.0);
    let north = Vector3::new(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat);
    let up = Vector3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat);
    let origin = Vector3::new(
        (n + home.z) * cos_lat * cos_lon,
        (n + home.z) * cos_lat * sin_lon,
        (n * (1.0 - E2) + home.z) * sin_lat,
    );
    let p = origin + east * enu.x + north * enu.y + up * enu.z;
    let r = p.xy().norm();
    let (mut lat, mut alt) = (p.z.atan2(r * (1.0 - E2)), 0.0);
    for _ in 0..8 {
        let n = A / (1.0 - E2 * lat.sin().powi(2)).sqrt();
        alt = r / lat.cos() - n;
        lat = p.z.atan2(r * (1.0 - E2 * n / (n + alt)));
    }
    Vector3::new(lat.to_degrees(), p.y.atan2(p.x).to_degrees(), alt)
}

#[test]
fn local_frame_on_the_ellipsoid() {
    for row in rows(&section("environment")["geodesy"]) {
        let (home, enu) = (vec3(&row["home"]), vec3(&row["enu"]));
        let frame = LocalFrame::new(home.x, home.y, home.z);
        let want = vec3(&row["radii_formula_lla"]);
        let (lat, lon, alt) = frame.to_geodetic(enu);
        close(lat, want.x, 1e-11);
        close(lon, want.y, 1e-11);
        close(alt, want.z, 1e-9);
        assert!((frame.to_enu(lat, lon, alt) - enu).norm() < 1e-6);
        let exact = exact_geodetic(home, enu);
        assert!((exact - vec3(&row["exact_tangent_plane_lla"])).amax() < 1e-7);
        // 3 mm and 5 mm at 250 m; both errors grow with the square of the distance.
        let distance = enu.xy().norm();
        let scale = (distance / 250.0).powi(2).max(0.05);
        let off = frame.to_enu(exact.x, exact.y, exact.z) - enu;
        assert!(off.xy().norm() < 0.0065 * scale, "{} m off at {distance} m", off.xy().norm());
        assert!(off.z.abs() < 0.0055 * scale, "{} m high at {distance} m", off.z);
    }
}

#[test]
fn magnetic_field_in_body_axes() {
    let mag = &section("environment")["mag_sitl"];
    let field = magnetic_field_enu(SITL_DECLINATION_DEG);
    let nwu = vec3(&mag["field_nwu_counts"]);
    assert!((field - Vector3::new(-nwu.y, nwu.x, nwu.z)).norm() < 1e-9);
    close(SITL_DECLINATION_DEG, num(&mag["declination_deg_east"]), 1e-9);
    close((-field.z).atan2(field.xy().norm()).to_degrees(), num(&mag["inclination_deg"]), 1e-9);
    let packets = &section("wire")["fdm"];
    for row in rows(&mag["rows"]) {
        let packet =
            rows(packets).iter().find(|packet| packet["id"] == row["id"]).expect("a packet of this id");
        let q = rows(&packet["true"]["q_body_flu_to_enu_wxyz"]);
        let q =
            UnitQuaternion::new_normalize(Quaternion::new(num(&q[0]), num(&q[1]), num(&q[2]), num(&q[3])));
        let body = q.inverse_transform_vector(&field);
        assert!((body - vec3(&row["mag"])).amax() < 0.01, "{}: {body}", row["id"]);
    }
}

/// The vectors take a knot as 0.514444 m/s, which is short by this share.
const KNOT: f64 = 1e-6;

#[test]
fn dryden_scales() {
    for row in rows(&section("environment")["dryden_8785C_low_altitude"]) {
        let scales = DrydenScales::at(num(&row["h_m"]), num(&row["W20_kt"]));
        near(scales.length_uv_m, num(&row["L_u_m"]), 1e-9);
        near(scales.length_uv_m, num(&row["L_v_m"]), 1e-9);
        near(scales.length_w_m, num(&row["L_w_m"]), 1e-9);
        near(scales.sigma_uv_mps, num(&row["sigma_u"]), KNOT);
        near(scales.sigma_uv_mps, num(&row["sigma_v"]), KNOT);
        near(scales.sigma_w_mps, num(&row["sigma_w"]), KNOT);
    }
}

#[test]
fn dryden_longitudinal_filter() {
    let example = &section("environment")["dryden_u_filter_example"];
    let scales = DrydenScales::at(15.24, Turbulence::Light.wind_at_20ft_kt());
    near(scales.length_uv_m, num(&example["L"]), 1e-9);
    near(scales.sigma_uv_mps, num(&example["sigma"]), KNOT);
    let (a, b) = scales.longitudinal_filter(num(&example["V"]), num(&example["dt"]));
    near(a, num(&example["a"]), 1e-12);
    near(scales.sigma_uv_mps * b, num(&example["b"]), KNOT);
}

#[test]
fn gust_shape() {
    let gust = &section("environment")["one_minus_cosine_gust"];
    let (peak, rise) = (num(&gust["A"]), num(&gust["T"]));
    for row in rows(&gust["rows"]) {
        let t = num(&row["t"]);
        close(one_minus_cosine(peak, rise, 3.0, t), num(&row["v"]), 1e-12);
        close(one_minus_cosine(peak, rise, 3.0, 2.0 * rise + 3.0 - t), num(&row["v"]), 1e-12);
    }
    assert_eq!(one_minus_cosine(peak, rise, 3.0, -0.1), 0.0);
    assert_eq!(one_minus_cosine(peak, rise, 3.0, 7.1), 0.0);
}
