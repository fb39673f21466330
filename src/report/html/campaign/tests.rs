use super::*;
use crate::campaign::{AnswerBuilder, Campaign, InputValue, Instant, Record, Shard, Side, Standing};
use crate::report::html::MAX_BYTES;
use crate::scenario::{BuiltinFiles, Flights, Request, read_request};

/// A campaign with a measure of this name and goals.
fn campaign(measure: &str) -> Campaign {
    let text = format!(
        "format = 1\n[plan]\nbuiltin = \"land\"\n[[measure]]\nname = {measure:?}\nfrom = \"boot\"\nmax = \"wind\"\n\
         [vary]\nmass_pct = \"+- 3\"\n[campaign]\nflights = 200\nexpect = ['success >= 99 %', 'max(time) <= 90 s']\n"
    );
    let request = Request {
        file: "plan.toml",
        text: &text,
        seeds: None,
        max_flights: 1000,
        flights: Flights::OfCampaign { is_drawn: true },
    };
    Campaign::new(read_request(&request, &mut BuiltinFiles).expect("a scenario"), None, None)
        .expect("flights")
}

/// Returns a flight that fails in strong winds.
fn flight(number: u64, side: Side, name: &str) -> Record {
    let (wind_mps, from_deg) = ((number * 37 % 120) as f64 / 10.0, (number * 71 % 360) as f64);
    let passed = wind_mps <= 9.0;
    let unit = |step: u64| (number * step % 100) as f64 / 100.0;
    Record {
        number,
        side,
        seed: number,
        inputs: vec![
            ("air".to_owned(), InputValue::Word(name.to_owned())),
            ("mass_pct".to_owned(), InputValue::Number(unit(13) * 6.0 - 3.0)),
            ("wind_from_deg".to_owned(), InputValue::Number(from_deg)),
            ("wind_mps".to_owned(), InputValue::Number(wind_mps)),
        ],
        standing: if passed { Standing::Passed } else { Standing::Failed },
        problem: None,
        result: if passed { "complete" } else { "crashed" }.to_owned(),
        reason: name.to_owned(),
        failures: if passed { Vec::new() } else { vec![name.to_owned()] },
        margin: Some(unit(7)),
        worst_at: Some(Instant { seconds: 12.0, is_from_boot: false }),
        metrics: vec![
            ("cross_track".to_owned(), wind_mps * 0.3 + unit(11)),
            ("touchdown".to_owned(), unit(17)),
            ("battery_left".to_owned(), 0.8 + unit(19) / 10.0),
            ("time".to_owned(), 60.0 + unit(23)),
        ],
        flown_s: 60.0,
        hash: number,
    }
}

/// Returns the page of so many flights with texts of this name.
fn page(name: &str, flights: u64, has_two_sides: bool) -> String {
    let campaign = campaign("blow");
    let mut builder = AnswerBuilder::new(campaign.scenario(), flights, has_two_sides);
    for number in 1..=flights {
        builder.add(&flight(number, Side::A, name));
        if has_two_sides {
            builder.add(&flight(number, Side::B, name));
        }
    }
    let answer = builder.answer();
    let reported = Reported {
        answer: &answer,
        name,
        version: "0.1.0",
        design: Some("sobol".to_owned()),
        run: Some("run.jsonl"),
        sides: has_two_sides.then(|| ["as given".to_owned(), name.to_owned()]),
        shard: (!has_two_sides).then_some(Shard::WHOLE),
    };
    let page = CampaignPage {
        kind: "Campaign by betadeck",
        reported: &reported,
        verdict: None,
        command: Some("betadeck campaign land --flights 200"),
    };
    campaign_page(&page, "betadeck 0.1.0")
}

#[test]
fn the_page_of_a_campaign_answers_and_shows_why() {
    let page = page("land", 200, false);
    let elements = crate::report::html::tests::elements(&page);
    let figures = elements.iter().filter(|name| *name == "figure").count();
    // The four metrics, one to three causes, two inputs against each other, and metrics over inputs.
    assert!((6..=12).contains(&figures), "{figures}");
    for part in [
        "<h1>land</h1>",
        "✗ not as expected",
        "succeeded (",
        "with 95 % confidence)",
        "<dt>design</dt><dd>sobol</dd>",
        "<code>success &#62;= 99 %</code></th><td class=\"failed\">✗ ",
        "<td class=\"passed\">✓ 6",
        "<th scope=\"row\">wind_mps above 9",
        "<th scope=\"row\">cross_track</th>",
        "<title id=\"distribution-0-title\">cross_track</title>",
        "<title id=\"failures-0-title\">Failures by wind_mps</title>",
        "<title id=\"scatter-0-title\">",
        "<code>betadeck open run.jsonl:",
        "<code>betadeck campaign land --flights 200</code>",
        "Half of the landings",
    ] {
        assert!(page.contains(part), "{part} is not in the page");
    }
    assert!(page.contains("prefers-color-scheme: dark") && page.contains("@media print"));
}

#[test]
fn a_campaign_of_two_sides_has_their_comparison() {
    let page = page("land", 40, true);
    crate::report::html::tests::elements(&page);
    assert!(page.contains("<h2>Two sides</h2>") && page.contains("McNemar"), "{page}");
    assert!(page.contains("<dt>side B</dt><dd>land</dd>"));
}

#[test]
fn a_campaign_without_a_flight_has_a_page_too() {
    let page = page("land", 0, false);
    crate::report::html::tests::elements(&page);
    assert!(page.contains("nothing was judged"));
}

#[test]
fn a_name_cannot_add_markup_to_a_campaign() {
    let elements = crate::report::html::tests::elements;
    let hostile = "</title><script>a('\"');</script><img src=x onerror=a()>&amp;";
    assert_eq!(elements(&page(hostile, 60, true)), elements(&page(&"x".repeat(60), 60, true)));
}

#[test]
fn a_campaign_of_many_flights_fits_into_a_page() {
    let page = page(&"long ".repeat(80), 20_000, false);
    crate::report::html::tests::elements(&page);
    assert!((50_000..=MAX_BYTES).contains(&page.len()), "{}", page.len());
    assert!(page.contains("Of many flights some are left out."));
}
