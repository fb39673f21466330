//! `--report` and `--markdown` of the built executable: pages and tables about flights.

use quick_xml::Reader;
use quick_xml::events::Event;

use crate::binary::support::Sandbox;
use test_support::MadeLog;

/// The greatest size of a page, bytes.
const MAX_BYTES: usize = 1_000_000;

/// A plan that lands a short way north, with a name that would be markup if it were not escaped.
const HOP: &str = "\
name = \"<script>alert(1)</script> & co\"
[home]
lat_deg = 40.4635
lon_deg = -79.5182
[[waypoint]]
type = \"LAND\"
lat_deg = 40.4635900
lon_deg = -79.5182
alt_m = 4
";
/// A field around home.
const FIELD: &str = "{\"type\":\"Feature\",\"properties\":{\"name\":\"a <b> field\"},\"geometry\":{\"type\":\"Polygon\",\
                     \"coordinates\":[[[-79.5183,40.4634],[-79.5181,40.4634],[-79.5181,40.4637],[-79.5183,40.4637],\
                     [-79.5183,40.4634]]]}}";
/// Options that make the flight short.
const QUICKLY: [&str; 3] = ["--takeoff=4", "--rate=400", "--noise=none"];

/// Reads a page, and fails if it is not well-formed, too large, or needs something else.
fn page(sandbox: &Sandbox, name: &str) -> String {
    let page = sandbox.read(name);
    assert!(page.starts_with("<!DOCTYPE html>\n<!-- betadeck report -->\n"), "{name}");
    assert!(page.len() <= MAX_BYTES, "{name}: {}", page.len());
    let mut reader = Reader::from_str(&page);
    loop {
        match reader.read_event().expect("a well-formed page") {
            Event::Start(element) | Event::Empty(element) => {
                let tag = element.name();
                assert!(!["script", "img", "link"].contains(&tag.as_ref()), "{name}: {tag:?}");
                for attribute in element.attributes() {
                    let key = attribute.expect("an attribute").key;
                    assert!(!["src", "href"].contains(&key.as_ref()), "{name}: {tag:?} {key:?}");
                }
            }
            Event::Eof => return page,
            _ => {}
        }
    }
}

#[test]
fn the_report_of_a_flight_is_the_same_each_time_and_names_its_command() {
    let sandbox = Sandbox::new();
    sandbox.write("hop.toml", HOP);
    sandbox.write("field.geojson", FIELD);
    let command =
        [&["fly", "hop.toml"][..], &QUICKLY, &["--wind", "2@270", "--set", "ap_max_angle=20"]].concat();
    let outputs = ["--report", "hop.html", "--markdown", "hop.md", "--backdrop", "field.geojson"];
    let run = || {
        sandbox.run(&[&command[..], &outputs].concat()).exits(0);
        (page(&sandbox, "hop.html"), sandbox.read("hop.md"))
    };
    let (html, markdown) = run();
    assert_eq!((&html, &markdown), (&run().0, &run().1), "reports of equal flights are equal");
    let repeat =
        "betadeck fly hop.toml --takeoff 4 --rate 400 --noise none --wind 2@270 --set ap_max_angle=20";
    for part in [
        "<h1>&#60;script&#62;alert(1)&#60;/script&#62; &#38; co</h1>",
        "✓ complete",
        "<dd>2.0 m/s from 270°</dd>",
        "LANDING</th><td class=\"nowrap\">WP0 LAND</td><td>the descent begins</td>",
        "<td class=\"nowrap\">touchdown time</td>",
        "<code>ap_max_angle</code></th><td><code>20</code></td><td><code>50</code></td>",
        "a &lt;b&gt; field</text>",
    ] {
        assert!(html.contains(part), "{part} is not in the page");
    }
    let shown =
        html.split_once("<code>betadeck fly").map(|(_, rest)| rest.split_once("</code>").expect("an end").0);
    assert_eq!(shown.map(|rest| format!("betadeck fly{rest}")).as_deref(), Some(repeat));
    assert!(
        markdown
            .starts_with("<!-- betadeck flight -->\n### ✅ &lt;script>alert(1)&lt;/script> & co: complete\n")
    );
    assert!(markdown.contains("| WP0 LAND |") && markdown.contains("(default `50`)"), "{markdown}");
}

#[test]
fn a_report_about_a_flight_that_failed_says_why() {
    let sandbox = Sandbox::new();
    let options = ["--fault", "wind@20,,20@0", "--report", "land.html", "--markdown", "land.md"];
    sandbox.run(&[&["fly", "land"][..], &options].concat()).exits(1);
    let html = page(&sandbox, "land.html");
    assert!(html.contains("✗ missed") && html.contains("but the craft touched down"));
    assert!(html.contains("class=\"number failed\""), "the margin of the landing is negative");
    assert!(sandbox.read("land.md").contains("### ❌ land: missed"));
    // A report needs a craft that was there.
    sandbox.run(&["fly", "missing.toml", "--report", "land.html", "--markdown", "land.md"]).exits(3);
    assert_eq!(sandbox.names(), [""; 0], "they are those of the earlier flight");
}

#[test]
fn a_report_that_cannot_be_written_ends_the_command() {
    let sandbox = Sandbox::new();
    sandbox.write("hop.toml", HOP);
    sandbox.write("mine.html", "<!DOCTYPE html>\n<html>\n");
    let ran = sandbox.run(&["fly", "hop.toml", "--report", "hop.toml"]).exits(2);
    assert!(ran.err.contains("--report hop.toml would overwrite the plan"), "{}", ran.err);
    sandbox.run(&["fly", "missing.toml", "--report", "mine.html"]).exits(2);
    assert!(sandbox.path("mine.html").exists(), "it is a page of somebody else");
    let ran = sandbox.run(&["fly", "hop.toml", "--report", "x.html", "--backdrop", "missing.kml"]).exits(3);
    assert!(ran.err.contains("missing.kml"), "{}", ran.err);
    sandbox.run(&["fly", "hop.toml", "--backdrop", "missing.kml"]).exits(2);
    #[cfg(target_os = "linux")]
    {
        let ran =
            sandbox.run(&[&["fly", "hop.toml", "--report", "/dev/full"][..], &QUICKLY].concat()).exits(3);
        assert!(ran.err.contains("cannot write /dev/full: No space left"), "{}", ran.err);
    }
}

#[test]
fn the_report_of_a_check_shows_failed_flights_first() {
    let sandbox = Sandbox::new();
    let scenario = |highest: &str| {
        format!("format = 1\n[plan]\nbuiltin = \"land\"\n[[expect]]\nmax = \"altitude <= {highest} m\"\n")
    };
    sandbox.write("low.toml", &scenario("1"));
    sandbox.write("high.toml", &scenario("100"));
    let run = || {
        sandbox.run(&["check", "high.toml", "low.toml", "--report", "check.html"]).exits(1);
        page(&sandbox, "check.html")
    };
    let html = run();
    assert!(html == run(), "reports of equal runs are equal");
    let at = |part: &str| html.find(part).unwrap_or_else(|| panic!("{part} is not in the page"));
    assert!(at("<summary>✗ low</summary>") < at("<summary>✓ high</summary>"));
    assert!(html.contains("1 of 2 flights passed") && html.contains("betadeck open low.toml --at "));
    assert!(html.contains("betadeck check high.toml low.toml"));
}

#[test]
fn the_report_of_a_comparison_has_both_tracks() {
    let sandbox = Sandbox::new();
    sandbox.write("hop.toml", HOP);
    let both = ["compare", "hop.toml", "--firmware", "embedded", "--firmware", "embedded"];
    let outputs = ["--report", "both.html", "--markdown", "both.md", "--svg", "both.svg"];
    sandbox.run(&[&both[..], &QUICKLY, &outputs].concat()).exits(0);
    let html = page(&sandbox, "both.html");
    assert!(html.contains("✓ both complete") && html.contains("touchdown beside the LAND point"));
    assert!(html.contains("betadeck compare hop.toml --firmware embedded --firmware embedded"));
    let markdown = sandbox.read("both.md");
    assert!(
        markdown.contains("| measure | before (A: embedded) | after (B: embedded) | B − A |"),
        "{markdown}"
    );
    let svg = sandbox.read("both.svg");
    assert!(svg.contains("A: embedded</text>") && svg.trim_end().ends_with("</svg>"));
    // A comparison that cannot fly leaves the files alone.
    sandbox.run(&[&["compare", "missing.toml"][..], &both[2..], &outputs].concat()).exits(3);
    assert_eq!(page(&sandbox, "both.html"), html);
}

#[test]
fn the_report_of_a_log_has_its_track_its_modes_and_its_settings() {
    let sandbox = Sandbox::new();
    std::fs::write(sandbox.path("a.bbl"), MadeLog::default().bytes()).expect("a writable directory");
    sandbox.write("field.geojson", FIELD);
    let command = ["replay", "a.bbl", "--log", "1"];
    let outputs = ["--report", "a.html", "--backdrop", "field.geojson"];
    let ran = sandbox.run(&[&command[..], &outputs].concat()).exits(0);
    assert_eq!((ran.out.as_str(), ran.err.as_str()), ("", ""));
    let html = page(&sandbox, "a.html");
    for part in [
        "<h1>a.bbl</h1>",
        "– recorded",
        "<dt>recorded</dt><dd>20.0 s</dd>",
        "AUTOPILOT</text>",
        "coloured by flight mode",
        "<h2>Open it again</h2>",
        "a &lt;b&gt; field</text>",
        "from the defaults of this firmware.",
        "Armed.",
        "betadeck replay a.bbl --log 1</code>",
    ] {
        assert!(html.contains(part), "{part} is not in the page");
    }
    let ran = sandbox.run(&["replay", "a.bbl", "--report", "a.bbl"]).exits(2);
    assert!(ran.err.contains("--report a.bbl would overwrite the recorded flight"), "{}", ran.err);
    sandbox.run(&["replay", "a.bbl", "--backdrop", "field.geojson"]).exits(2);
}
