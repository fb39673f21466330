//! Tests of the readers of maps.

use super::*;
use crate::plan::feature::Vertex;
use crate::plan::format::report;

fn read(text: &str) -> Vec<Feature> {
    read_features("map", text.as_bytes()).unwrap_or_else(|errors| panic!("{}", report(&errors)))
}

fn faults(contents: impl AsRef<[u8]>) -> Vec<String> {
    let errors = read_features("m", contents.as_ref()).unwrap_err();
    errors.iter().map(PlanError::headline).collect()
}

/// Returns name, shape in short and zone of each feature.
fn short(features: &[Feature]) -> Vec<String> {
    let vertex = |v: &Vertex| format!("{} {} {}", v.position.lat_deg(), v.position.lon_deg(), v.altitude_m);
    let one = |feature: &Feature| {
        let shape = match &feature.shape {
            Shape::Point(v) => format!("point {}", vertex(v)),
            Shape::Line(line) => format!("line {} from {}", line.len(), vertex(&line[0])),
            Shape::Area(rings) => format!("area {:?}", rings.iter().map(Vec::len).collect::<Vec<_>>()),
        };
        let zone = feature.zone.map(|zone| format!(" {zone:?}")).unwrap_or_default();
        format!("{}: {shape}{zone}", feature.name)
    };
    features.iter().map(one).collect()
}

#[test]
fn kml_shapes_are_read() {
    let text = "<?xml version='1.0'?>\n<!-- x --><kml xmlns='http://www.opengis.net/kml/2.2' xmlns:gx='g'><Document>\
        <name>d</name><Style id='s'/><Folder><name>f</name>\
        <Placemark><name>p</name><Point><coordinates> 2,1,5 </coordinates></Point></Placemark>\
        <Placemark><LineString><coordinates>2,1,5 2,<![CDATA[1.5]]>\n\t3,2.25</coordinates></LineString><name>l</name>\
        </Placemark></Folder>\
        <NetworkLink><Link><href>http://x</href></Link></NetworkLink>\
        <Placemark><name>a</name><ExtendedData><Data name='zone'><value>exclusion</value></Data></ExtendedData>\
        <MultiGeometry><Polygon><innerBoundaryIs><LinearRing><coordinates>1,1 2,1 2,2 1,1</coordinates></LinearRing>\
        </innerBoundaryIs><outerBoundaryIs><LinearRing><coordinates>0,0 9,0 9,9 0,9 0,0</coordinates></LinearRing>\
        </outerBoundaryIs></Polygon><LinearRing><coordinates>0,0 1,0 1,1 0,0</coordinates></LinearRing>\
        <Point><coordinates>7,8</coordinates></Point></MultiGeometry></Placemark>\
        <Placemark><name>t</name><gx:MultiTrack><gx:Track><when>2026-01-01T00:00:00Z</when>\
        <gx:coord>2 1 5</gx:coord><gx:coord/><gx:coord>2 1.5 6</gx:coord></gx:Track></gx:MultiTrack></Placemark>\
        <Placemark><Polygon/><LineString><coordinates>1,2</coordinates></LineString></Placemark>\
        </Document></kml>";
    assert_eq!(
        short(&read(text)),
        [
            "p: point 1 2 5",
            "l: line 3 from 1 2 5",
            "a: area [4, 3] Exclusion",
            "a: area [3] Exclusion",
            "a: point 8 7 NaN",
            "t: line 2 from 1 2 5",
        ]
    );
    let archive = kmz::packed(text).unwrap();
    let of_archive = read_features("m.kmz", &archive).unwrap();
    assert_eq!(short(&of_archive), short(&read(text)));
    assert_eq!(kmz::packed(text).unwrap(), archive);
}

#[test]
fn gpx_shapes_are_read() {
    let text = "\u{feff}<gpx version='1.1'><metadata><name>m</name></metadata>\
        <wpt lat='1' lon='2'><ele>5</ele><name>w</name></wpt><wpt lat='1' lon='2'/>\
        <rte><name>r</name><rtept lat='1' lon='2'/><rtept lat='1.5' lon='2'><ele/></rtept></rte>\
        <rte><rtept lat='1' lon='2'/></rte>\
        <trk><name>t</name><trkseg><trkpt lat='1' lon='362'><ele>7.5</ele></trkpt><trkpt lat='1' lon='2.1'/></trkseg>\
        <trkseg><trkpt lat='3' lon='2'/><trkpt lat='4' lon='2'/><trkpt lat='5' lon='2'/></trkseg></trk></gpx>";
    assert_eq!(faults(text), ["m:1:280: longitude 362 is out of range, allowed: -180 to 180"]);
    assert_eq!(
        short(&read(&text.replace("362", "-358"))),
        [
            "w: point 1 2 5",
            ": point 1 2 NaN",
            "r: line 2 from 1 2 NaN",
            "t: line 2 from 1 2 7.5",
            "t: line 3 from 3 2 NaN",
        ]
    );
}

#[test]
fn geojson_shapes_are_read() {
    let text = r#"{"type":"FeatureCollection","name":"layer","crs":{"type":"name","properties":
        {"name":"urn:ogc:def:crs:OGC:1.3:CRS84"}},"features":[
        {"type":"Feature","properties":{"Name":"p","x":{"y":[1,{}]},"z":[1]},"geometry":{"type":"Point","coordinates":[2,1,5,9]}},
        {"geometry":{"coordinates":[[2,1],[3,2,null]],"type":"LineString","bbox":[1,2,3,4]},"type":"Feature","properties":null},
        {"type":"Feature","id":7,"properties":{"name":5,"zone":"Inclusion"},"geometry":{"type":"Polygon",
         "coordinates":[[[0,0],[9,0],[9,9],[0,0]],[[1,1],[2,1],[2,2],[1,1]],[]]}},
        {"type":"Feature","properties":{"featureType":"geofence","inclusion":false},"geometry":{"type":"MultiPolygon",
         "coordinates":[[[[0,0],[9,0],[9,9],[0,0]]],[[[1,1],[2,1],[2,2],[1,1]]]]}},
        {"type":"Feature","properties":{},"geometry":null},
        {"type":"Feature","properties":{},"geometry":{"type":"GeometryCollection","geometries":[
         {"type":"MultiPoint","coordinates":[[2,1],[3,2]]},
         {"type":"MultiLineString","coordinates":[[[2,1],[3,2]],[[2,1],[3,2],[4,3]]]},
         {"type":"Point","coordinates":[]}]}}]}"#;
    assert_eq!(
        short(&read(text)),
        [
            "p: point 1 2 5",
            ": line 2 from 1 2 NaN",
            "5: area [3, 3] Inclusion",
            ": area [3] Exclusion",
            ": area [3] Exclusion",
            ": point 1 2 NaN",
            ": point 2 3 NaN",
            ": line 2 from 1 2 NaN",
            ": line 3 from 1 2 NaN",
        ]
    );
    assert_eq!(short(&read(r#" {"type":"Point","coordinates":[2,1]}"#)), [": point 1 2 NaN"]);
    let feature =
        r#"{"type":"Feature","properties":{"name":"f"},"geometry":{"type":"Point","coordinates":[2,1]}}"#;
    assert_eq!(short(&read(feature)), ["f: point 1 2 NaN"]);
}

#[test]
fn a_misspelt_zone_is_named_and_a_foreign_word_is_none() {
    let area = |zone: &str| {
        format!(
            r#"{{"type":"Feature","properties":{{"name":"f","zone":"{zone}"}},"geometry":{{"type":"Polygon",
            "coordinates":[[[0,0],[9,0],[9,9],[0,0]]]}}}}"#
        )
    };
    for word in ["exclusin", "Exlcusion", "exclusions"] {
        let found = faults(area(word)).concat();
        assert!(found.contains(&format!("zone {word} is not known; did you mean exclusion?")), "{found}");
    }
    assert_eq!(short(&read(&area(" EXCLUSION "))), ["f: area [3] Exclusion"]);
    assert_eq!(short(&read(&area("residential"))), ["f: area [3]"]);
    let kml = "<kml><Placemark><ExtendedData><Data name='zone'><value>inclsion</value></Data></ExtendedData>\
        <Polygon><outerBoundaryIs><LinearRing><coordinates>0,0 9,0 9,9 0,0</coordinates></LinearRing>\
        </outerBoundaryIs></Polygon></Placemark></kml>";
    assert!(faults(kml).concat().contains("did you mean inclusion?"));
}

#[test]
fn hostile_geojson_is_one_sentence() {
    let geometry = |text: &str| faults(format!("{{\"type\":\"Feature\",\"geometry\":{text}}}"));
    assert_eq!(
        geometry("{\"type\":\"Point\",\"coordinates\":[2,91]}"),
        ["m:1:65: latitude 91 is out of range, allowed: -90 to 90"]
    );
    for (coordinates, message) in [
        ("[1e999,1]", "number out of range"),
        ("[NaN,1]", "expected value"),
        ("[40,4635]", "latitude 4635 is out of range"),
        ("[1]", "a position is [LON, LAT] or [LON, LAT, ALT]"),
        ("[\"1\",2]", "invalid type: string \"1\", expected a number of a coordinate"),
        ("[[1,2],3]", "a coordinate is not a number"),
        ("[[1,2],[[1,2]]]", "nested unevenly"),
        ("[[[[[[[1,2]]]]]]]", "nested too deep"),
        ("[1,2,99999]", "altitude 99999 is out of range"),
        ("[[1,2]]", "these are not the coordinates of a Point"),
    ] {
        let found = geometry(&format!("{{\"type\":\"Point\",\"coordinates\":{coordinates}}}"));
        assert!(found.len() == 1 && found[0].contains(message), "{coordinates}: {found:?}");
    }
    for (text, message) in [
        ("{\"type\":\"Point\",\"type\":\"Point\"}", "the key \"type\" is there twice"),
        ("{\"a\":1}", "the type is missing"),
        ("{\"type\":\"Polygone\"}", "the type \"Polygone\" does not belong here"),
        ("{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Point\"}]}", "does not belong here"),
        ("{\"type\":\"Point\",\"coordinates\":[1,2]} x", "trailing characters"),
        (
            "{\"type\":\"Point\",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":\"EPSG:25832\"}}}",
            "EPSG:25832 is not WGS 84",
        ),
        ("{\"type\":\"Feature\",\"properties\":{\"a\":1,\"a\":2}}", "the key \"a\" is there twice"),
    ] {
        assert!(faults(text)[0].contains(message), "{text}: {:?}", faults(text));
    }
    let open = "{\"type\":\"GeometryCollection\",\"geometries\":[";
    assert!(faults(open.repeat(100_000))[0].contains("recursion limit exceeded"));
    let coordinates = format!("{{\"coordinates\":{}", "[".repeat(100_000));
    assert!(faults(coordinates)[0].contains("nested too deep"));
}

#[test]
fn hostile_xml_is_one_sentence() {
    let line = |text: &str| faults(format!("<kml><Placemark><LineString><coordinates>\n{text}"));
    assert_eq!(line("1,2 3,91 4,5")[0], "m:2:5: latitude 91 is out of range, allowed: -90 to 90");
    for (text, message) in [
        ("1,2 nan,3 ", "longitude NaN is out of range"),
        ("1,2 3,inf ", "latitude inf is out of range"),
        ("7,5,47,4,100 ", "7,5,47,4,100 is not a point"),
        ("1 2 ", "1 is not a point"),
        ("1,2,99999 ", "altitude 99999 is out of range"),
        ("1,2x ", "latitude 2x is not a number"),
        (&"1".repeat(99_999), "a point has more than 256 characters"),
    ] {
        assert!(line(text)[0].contains(message), "{text}: {:?}", line(text));
    }
    let bomb = "<!DOCTYPE kml [<!ENTITY a 'b'>]><kml>&a;</kml>";
    assert!(faults(bomb)[0].contains("a document type is not allowed"));
    assert!(faults(format!("<kml>{}", "<Folder>".repeat(99_999)))[0].contains("nested deeper than 64"));
    assert!(
        faults("<gpx><wpt lat='40,46' lon='1'/></gpx>")[0].contains("latitude 40,46 has a decimal comma")
    );
    assert!(faults("<gpx><wpt lat='40'/></gpx>")[0].contains("the longitude is missing: <wpt> has no lon"));
    assert!(
        faults("<gpx><wpt lat='1' lon='1'><ele>1e9</ele></wpt></gpx>")[0].contains("altitude 1000000000")
    );
    let wrong = "<wpt lat='91' lon='1'/>".repeat(1000);
    assert_eq!(faults(format!("<gpx>{wrong}</gpx>")).len(), MAX_PROBLEMS);
    for text in ["", "x", "<a/>", "<?xml", "<!--", "[1]", "<kml", "\u{0}"] {
        assert!(faults(text)[0].contains("m:1:1: "), "{text}");
    }
    assert!(faults(b"\xff\xfe\x00")[0].contains("UTF-16"));
}

#[test]
fn many_shapes_and_points_are_refused() {
    let points = "[1,2],".repeat(BACKDROP.features);
    let text = format!("{{\"type\":\"MultiPoint\",\"coordinates\":[{points}[1,2]]}}");
    assert!(faults(text)[0].contains("more than 100000 shapes"));
    let text = format!("<gpx>{}</gpx>", "<wpt lat='1' lon='1'/>".repeat(BACKDROP.features + 1));
    assert!(faults(text)[0].contains("more than 100000 shapes"));
    let mut counter = 0;
    let mut problems = Problems::new("m", "");
    let mut take = |_: MapFeature| counter += 1;
    let limits = Limits { vertices: 3, ..BACKDROP };
    let text = "<kml><Placemark><LineString><coordinates>1,1 1,1 1,1 1,1</coordinates></LineString></Placemark></kml>";
    MapKind::Kml.read(text, &mut Collector::new(&mut problems, limits, &mut take));
    assert!(problems.into_errors()[0].message.contains("more than 3 points"));
    assert_eq!(counter, 1);
}

#[test]
fn hostile_archives_are_one_sentence() {
    let zeros = " ".repeat(10 << 20);
    let bomb = kmz::packed(&format!("<kml/>{zeros}")).unwrap();
    assert!(faults(&bomb)[0].contains("the document is packed more than 200 times"), "{:?}", faults(&bomb));
    // The size in the archive is a lie: the local header has none, the directory says one byte.
    let mut lie = bomb.clone();
    let at = lie.windows(4).rposition(|bytes| bytes == b"PK\x01\x02").unwrap();
    lie[at + 24..at + 28].copy_from_slice(&1_u32.to_le_bytes());
    assert!(faults(&lie)[0].contains("the archive cannot be read: File is larger"), "{:?}", faults(&lie));
    assert_eq!(
        kmz::unpacked(&kmz::packed("ab").unwrap(), 1).unwrap_err(),
        "the document has more than 0 MiB"
    );

    let archive = |names: &[&str]| {
        let mut writer = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
        for name in names {
            writer.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
            std::io::Write::write_all(&mut writer, b"<kml/>").unwrap();
        }
        writer.finish().unwrap().into_inner()
    };
    assert_eq!(read_features("m", &archive(&["files/a.png", "../../etc/x.KML"])).unwrap(), []);
    assert!(faults(archive(&["a.txt"]))[0].contains("the archive has no KML document"));
    let names: Vec<String> = (0..101).map(|at| format!("{at}.png")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    assert!(faults(archive(&names))[0].contains("the archive has more than 100 members"));
    let good = archive(&["doc.kml"]);
    let mut encrypted = good.clone();
    let at = encrypted.windows(4).rposition(|bytes| bytes == b"PK\x01\x02").unwrap();
    encrypted[at + 8] |= 1;
    assert!(faults(&encrypted)[0].contains("the archive is encrypted"), "{:?}", faults(&encrypted));
    for end in [4, 5, 30, good.len() / 2, good.len() - 1] {
        assert!(faults(&good[..end])[0].contains("the archive cannot be read"), "{end}");
    }
}

#[test]
fn the_first_element_gives_the_kind() {
    for (text, kind) in [
        ("<kml>", Some(MapKind::Kml)),
        ("<?xml version='1.0'?><!-- <gpx> --><k:kml x='1'>", Some(MapKind::Kml)),
        (" \n<gpx/>", Some(MapKind::Gpx)),
        ("{", Some(MapKind::GeoJson)),
        ("<mission>", None),
        ("<!-- <gpx>", None),
        ("gpx", None),
    ] {
        assert_eq!(MapKind::from_text(text), kind, "{text}");
    }
}
