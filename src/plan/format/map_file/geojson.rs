//! The reader of GeoJSON (RFC 7946). Visitors read features one after the other, without a tree of the file.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};

use super::collector::{Altitudes, Collector, MapFeature, Piece, Properties};
use super::positions::{Positions, PositionsSeed};
use crate::plan::format::json;
use crate::plan::format::loss::Place;

/// The names of WGS 84 in a `crs` member.
const WGS_84: &[&str] = &["CRS84", "CRS84h", "EPSG::4326", "EPSG:4326", "EPSG::4979", "EPSG:4979", "WGS84"];

/// The types of objects that are a file.
const TYPES: &[&str] = &[
    "FeatureCollection",
    "Feature",
    "Point",
    "MultiPoint",
    "LineString",
    "MultiLineString",
    "Polygon",
    "MultiPolygon",
    "GeometryCollection",
];

/// Returns `true` if a text is GeoJSON: it has an object with a type of GeoJSON, and it is no plan of QGroundControl.
pub(in crate::plan::format) fn is_geojson(text: &str) -> bool {
    let is_type = |at: usize| {
        let value = text[at..].trim_start().strip_prefix(':').map(str::trim_start);
        let word = value.and_then(|value| value.strip_prefix('"')?.split('"').next());
        word.is_some_and(|word| TYPES.contains(&word))
    };
    text.trim_start().starts_with('{')
        && !text.contains("\"fileType\"")
        && text.match_indices("\"type\"").any(|(at, key)| is_type(at + key.len()))
}

/// Reads a text.
pub(super) fn read(text: &str, collector: &mut Collector<'_, '_>) {
    let mut reader = serde_json::Deserializer::from_str(text);
    let seed = ObjectSeed { collector, role: Role::Root };
    let read = seed.deserialize(&mut reader).and_then(|object| reader.end().map(|()| object));
    let read = read.and_then(|object| match object.of_type.as_str() {
        "FeatureCollection" => Ok(()),
        // `Feature` and geometries alone.
        _ => give(object, collector, None).map_err(Error::custom),
    });
    if let Err(error) = read {
        json::add_fault(text, &error, collector.problems);
    }
}

/// Passes a feature on.
fn give(object: Object, collector: &mut Collector<'_, '_>, index: Option<usize>) -> Result<(), String> {
    let place = index.map(|index| Place::Pointer { pointer: format!("/features/{index}") });
    let Object { properties, name, mut pieces, .. } = object;
    // GDAL keeps the altitude mode of a KML file as a property.
    if let Some(mode) = properties.get("altitudeMode").and_then(Altitudes::from_mode) {
        pieces.iter_mut().for_each(|piece| piece.altitudes = mode);
    }
    collector.feature(MapFeature { name, properties, pieces, place, ..MapFeature::default() })
}

/// The role of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// The whole file: a collection, a feature or a geometry.
    Root,
    Feature,
    Geometry,
}

/// An object that was read.
#[derive(Debug, Default)]
struct Object {
    of_type: String,
    name: String,
    properties: Properties,
    pieces: Vec<Piece>,
}

struct ObjectSeed<'s, 'c, 'a> {
    collector: &'s mut Collector<'c, 'a>,
    role: Role,
}

impl<'de> DeserializeSeed<'de> for ObjectSeed<'_, '_, '_> {
    type Value = Object;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Object, D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for ObjectSeed<'_, '_, '_> {
    type Value = Object;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.role {
            Role::Root => "a GeoJSON object",
            Role::Feature => "a feature",
            Role::Geometry => "a geometry",
        })
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Object, A::Error> {
        let Self { collector, role } = self;
        let mut object = Object::default();
        let mut positions = Positions::Empty;
        let mut keys = BTreeSet::new();
        while let Some(key) = map.next_key::<Cow<'de, str>>()? {
            let key = key.into_owned();
            match key.as_str() {
                "type" => object.of_type = map.next_value()?,
                "coordinates" if role != Role::Feature => {
                    positions = map.next_value_seed(PositionsSeed(&mut collector.counter))?;
                }
                "geometries" if role != Role::Feature => {
                    object.pieces = map.next_value_seed(GeometriesSeed { collector: &mut *collector })?;
                }
                "geometry" if role != Role::Geometry => {
                    object.pieces = map.next_value_seed(GeometrySeed { collector: &mut *collector })?;
                }
                "properties" if role != Role::Geometry => {
                    map.next_value_seed(PropertiesSeed { object: &mut object })?;
                }
                "features" if role == Role::Root => {
                    map.next_value_seed(FeaturesSeed { collector: &mut *collector })?;
                }
                "crs" => {
                    map.next_value::<Option<Crs>>()?.map_or(Ok(()), Crs::check).map_err(Error::custom)?;
                }
                "betadeck" if role == Role::Root => {
                    map.next_value::<Private>()?.keep(collector);
                }
                _ => {
                    map.next_value::<IgnoredAny>()?;
                }
            }
            if keys.contains(&key) {
                return Err(A::Error::custom(format!("the key {key:?} is there twice")));
            }
            keys.insert(key);
        }
        let of_type = object.of_type.as_str();
        match (of_type, role) {
            ("", _) => return Err(A::Error::custom("the type is missing")),
            ("FeatureCollection", Role::Root) | ("Feature", Role::Root | Role::Feature) => {}
            ("GeometryCollection", Role::Root | Role::Geometry) => {}
            (
                "Point" | "MultiPoint" | "LineString" | "MultiLineString" | "Polygon" | "MultiPolygon",
                Role::Root | Role::Geometry,
            ) => {
                object.pieces =
                    positions.pieces(of_type, collector.limits.features).map_err(A::Error::custom)?;
            }
            _ => return Err(A::Error::custom(format!("the type {of_type:?} does not belong here"))),
        }
        Ok(object)
    }
}

/// Reads features and passes each on.
struct FeaturesSeed<'s, 'c, 'a> {
    collector: &'s mut Collector<'c, 'a>,
}

impl<'de> DeserializeSeed<'de> for FeaturesSeed<'_, '_, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for FeaturesSeed<'_, '_, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of features")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        let mut index = 0;
        loop {
            let seed = ObjectSeed { collector: &mut *self.collector, role: Role::Feature };
            let Some(feature) = list.next_element_seed(seed)? else { return Ok(()) };
            give(feature, self.collector, Some(index)).map_err(A::Error::custom)?;
            index += 1;
        }
    }
}

/// Reads a geometry or `null`.
struct GeometrySeed<'s, 'c, 'a> {
    collector: &'s mut Collector<'c, 'a>,
}

impl<'de> DeserializeSeed<'de> for GeometrySeed<'_, '_, '_> {
    type Value = Vec<Piece>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Vec<Piece>, D::Error> {
        deserializer.deserialize_option(self)
    }
}

impl<'de> Visitor<'de> for GeometrySeed<'_, '_, '_> {
    type Value = Vec<Piece>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a geometry or null")
    }

    fn visit_none<E>(self) -> Result<Vec<Piece>, E> {
        Ok(Vec::new())
    }

    fn visit_unit<E>(self) -> Result<Vec<Piece>, E> {
        Ok(Vec::new())
    }

    fn visit_some<D: Deserializer<'de>>(self, deserializer: D) -> Result<Vec<Piece>, D::Error> {
        let seed = ObjectSeed { collector: self.collector, role: Role::Geometry };
        seed.deserialize(deserializer).map(|object| object.pieces)
    }
}

/// Reads the geometries of a collection.
struct GeometriesSeed<'s, 'c, 'a> {
    collector: &'s mut Collector<'c, 'a>,
}

impl<'de> DeserializeSeed<'de> for GeometriesSeed<'_, '_, '_> {
    type Value = Vec<Piece>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Vec<Piece>, D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for GeometriesSeed<'_, '_, '_> {
    type Value = Vec<Piece>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of geometries")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Vec<Piece>, A::Error> {
        let mut pieces = Vec::new();
        loop {
            let seed = ObjectSeed { collector: &mut *self.collector, role: Role::Geometry };
            let Some(mut geometry) = list.next_element_seed(seed)? else { return Ok(pieces) };
            pieces.append(&mut geometry.pieces);
        }
    }
}

/// Reads the properties of a feature.
struct PropertiesSeed<'s> {
    object: &'s mut Object,
}

impl<'de> DeserializeSeed<'de> for PropertiesSeed<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for PropertiesSeed<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object of properties or null")
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let mut keys = BTreeSet::new();
        while let Some(key) = map.next_key::<Cow<'de, str>>()? {
            let key = key.into_owned();
            if let Some(value) = map.next_value::<Scalar>()?.0 {
                if key.eq_ignore_ascii_case("name") {
                    self.object.name = value;
                } else {
                    self.object.properties.add(&key, value);
                }
            }
            if keys.contains(&key) {
                return Err(A::Error::custom(format!("the key {key:?} is there twice")));
            }
            keys.insert(key);
        }
        Ok(())
    }
}

/// A text, number or truth value as text; `None` for any other value.
struct Scalar(Option<String>);

impl<'de> serde::Deserialize<'de> for Scalar {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ScalarVisitor).map(Self)
    }
}

struct ScalarVisitor;

impl<'de> Visitor<'de> for ScalarVisitor {
    type Value = Option<String>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Self::Value, E> {
        Ok(Some(value.to_string()))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Self::Value, E> {
        Ok(Some(value.to_string()))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Self::Value, E> {
        Ok(Some(value.to_string()))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Self::Value, E> {
        Ok(Some(value.to_string()))
    }

    fn visit_str<E>(self, value: &str) -> Result<Self::Value, E> {
        Ok(Some(value.to_owned()))
    }

    fn visit_unit<E>(self) -> Result<Self::Value, E> {
        Ok(None)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
        while list.next_element::<IgnoredAny>()?.is_some() {}
        Ok(None)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Ok(None)
    }
}

/// The `crs` of older files.
#[derive(serde::Deserialize)]
struct Crs {
    properties: Option<CrsProperties>,
}

#[derive(serde::Deserialize)]
struct CrsProperties {
    name: Option<String>,
}

impl Crs {
    fn check(self) -> Result<(), String> {
        let name = self.properties.and_then(|properties| properties.name);
        match name {
            Some(name) if WGS_84.iter().any(|known| name.ends_with(known)) => Ok(()),
            Some(name) => Err(format!(
                "the coordinate reference system {name} is not WGS 84: export the file in WGS 84 (EPSG:4326)"
            )),
            None => {
                Err("the coordinate reference system is not named: export the file in WGS 84 (EPSG:4326)"
                    .to_owned())
            }
        }
    }
}

/// Our own member of a collection.
#[derive(serde::Deserialize)]
struct Private {
    version: u32,
    #[serde(default)]
    name: String,
    #[serde(default)]
    description: String,
    #[serde(default)]
    settings: Vec<String>,
}

impl Private {
    fn keep(self, collector: &mut Collector<'_, '_>) {
        collector.properties.add("betadeck", self.version.to_string());
        collector.name = self.name;
        collector.description = self.description;
        for setting in self.settings {
            collector.properties.add("setting", setting);
        }
    }
}
