//! Decides which web pages may reach the craft.
//!
//! A browser lets any page on the net open a websocket to this machine, and names the page's origin. Without
//! a check a stranger's page could fly the craft. The host that the client names is checked too: a page can
//! make its own name point to this machine after it was loaded, and then its origin is not foreign.

use std::net::IpAddr;

/// The host of the hosted App. Its test versions are below it.
const APP: &str = "app.betaflight.com";

/// The maximum number of characters of an origin or a host in a notice.
const SHOWN_MAX: usize = 100;

/// The reason why a client is not served, worded for a notice.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(super) enum Refusal {
    /// A web page whose origin can be allowed.
    #[error(
        "A web page from {0} tried to reach the craft through the websocket and was refused: start with \
         --allow-origin {0} to serve it."
    )]
    Origin(String),
    /// A web page that could belong to anybody.
    #[error(
        "A web page without an origin of its own (a file, a sandboxed frame) tried to reach the craft through the \
         websocket and was refused: serve it from this machine, under http://localhost."
    )]
    NoOrigin,
    /// A name that does not belong to this machine. A page may have made it point here.
    #[error(
        "A client that addressed this machine as {0:?} tried to reach the craft through the websocket and was refused: \
         connect to its address, or start with --allow-origin http://NAME."
    )]
    Host(String),
}

/// Checks the origin of a page. Clients other than browsers do not name one.
pub(super) fn judge_origin(origin: &str, allowed: &[String]) -> Result<(), Refusal> {
    let origin = origin.trim().trim_end_matches('/');
    let is_served = is_app(origin)
        || allowed.iter().any(|allowed| allowed.trim_end_matches('/').eq_ignore_ascii_case(origin))
        || host(origin).is_some_and(is_loopback);
    if is_served {
        return Ok(());
    }
    // A truncated origin would not be served.
    let can_be_allowed = host(origin).is_some_and(|host| !host.is_empty()) && origin.len() <= SHOWN_MAX;
    Err(if can_be_allowed { Refusal::Origin(origin.to_owned()) } else { Refusal::NoOrigin })
}

/// Checks the name by which a client calls this machine. Allowed are names of the loopback, the address at
/// which the client reached the door, and the allowed hosts. A stranger's page whose name was made to point
/// to this machine has the same origin as the door that it reaches.
pub(super) fn judge_host(named: &str, own_address: IpAddr, allowed: &[String]) -> Result<(), Refusal> {
    let named = named.trim();
    let is_own = |host: &str| {
        host.parse::<IpAddr>().is_ok_and(|address| address.to_canonical() == own_address.to_canonical())
    };
    let is_allowed = |named: &str| {
        allowed
            .iter()
            .filter_map(|allowed| host(allowed.trim_end_matches('/')))
            .any(|host| host.eq_ignore_ascii_case(named))
    };
    match host_of_authority(named) {
        Some(host) if is_loopback(host) || is_own(host) || is_allowed(host) => Ok(()),
        _ => Err(Refusal::Host(named.chars().filter(char::is_ascii_graphic).take(SHOWN_MAX).collect())),
    }
}

/// Returns the host of `scheme://host` or `scheme://host:port`; `None` for anything else.
fn host(origin: &str) -> Option<&str> {
    let (scheme, authority) = origin.split_once("://")?;
    let in_scheme = |byte: u8| byte.is_ascii_alphanumeric() || b"+-.".contains(&byte);
    if scheme.is_empty() || !scheme.bytes().all(in_scheme) {
        return None;
    }
    host_of_authority(authority)
}

/// Returns the host of `host` or `host:port`; `None` for anything else.
fn host_of_authority(authority: &str) -> Option<&str> {
    let (host, port) = match authority.strip_prefix('[') {
        Some(rest) => match rest.split_once(']')? {
            (host, "") => (host, None),
            (host, rest) => (host, Some(rest.strip_prefix(':')?)),
        },
        None => match authority.split_once(':') {
            Some((host, port)) => (host, Some(port)),
            None => (authority, None),
        },
    };
    let is_port = |port: &str| !port.is_empty() && port.bytes().all(|byte| byte.is_ascii_digit());
    let in_host = |byte: u8| byte.is_ascii_alphanumeric() || b"-.:".contains(&byte);
    (port.is_none_or(is_port) && host.bytes().all(in_host)).then_some(host)
}

/// Returns `true` for the pages of the hosted App and of its test versions, by https and at the usual port.
fn is_app(origin: &str) -> bool {
    let origin = origin.to_ascii_lowercase();
    let Some(name) = origin.strip_prefix("https://").filter(|name| host(&origin) == Some(*name)) else {
        return false;
    };
    let below = name.strip_suffix(APP).and_then(|below| below.strip_suffix('.'));
    name == APP || below.is_some_and(|below| below.split('.').all(|label| !label.is_empty()))
}

/// Returns `true` for this machine by name or address. Names below `localhost` belong to this machine too:
/// the App's desktop and mobile shells use them, under their own schemes.
fn is_loopback(host: &str) -> bool {
    let host = host.to_ascii_lowercase();
    host == "localhost"
        || host.ends_with(".localhost")
        || host.parse::<IpAddr>().is_ok_and(|address| address.is_loopback())
}

#[cfg(test)]
mod tests {
    use super::{IpAddr, Refusal, judge_host, judge_origin};

    fn is_served(origin: Option<&str>, allowed: &[String]) -> bool {
        origin.is_none_or(|origin| judge_origin(origin, allowed).is_ok())
    }

    #[test]
    fn local_pages_shells_and_the_app_are_served() {
        assert!(is_served(None, &[]));
        for origin in [
            "http://localhost",
            "http://localhost:8080",
            "https://LocalHost:3000/",
            "http://127.0.0.1:5173",
            "http://127.9.9.9",
            "http://[::1]:8000",
            "https://app.betaflight.com",
            "https://master.app.betaflight.com",
            "https://Master.Dev.App.Betaflight.com/",
            "tauri://localhost",
            "http://tauri.localhost",
            "https://tauri.localhost",
            "capacitor://localhost",
            "ionic://localhost",
        ] {
            assert!(is_served(Some(origin), &[]), "{origin}");
        }
    }

    #[test]
    fn strangers_are_not() {
        for origin in [
            "",
            "null",
            "localhost",
            "://localhost",
            "https://evil.example",
            "http://app.betaflight.com",
            "https://app.betaflight.com.evil.example",
            "https://app.betaflight.com:444",
            "http://master.app.betaflight.com",
            "https://master.app.betaflight.com:444",
            "https://evilapp.betaflight.com",
            "https://evil.example.app.betaflight.com.evil.example",
            "https://.app.betaflight.com",
            "https://a..app.betaflight.com",
            "https://user@app.betaflight.com",
            "https://user@master.app.betaflight.com",
            "https://evil.example/.app.betaflight.com",
            "https://evil.example#.app.betaflight.com",
            "https://betaflight.com",
            "http://localhost.evil.example",
            "http://notlocalhost",
            "http://localhost@evil.example",
            "http://evil.example/localhost",
            "http://127.0.0.1.evil.example",
            "http://[::1].evil.example",
            "http://[::1]evil",
            "http://localhost:80@evil.example",
            "http://192.168.0.1",
            "http://0.0.0.0",
        ] {
            assert!(!is_served(Some(origin), &[]), "{origin}");
        }
    }

    #[test]
    fn others_by_name() {
        let allowed = ["https://my.page/".to_owned()];
        assert!(is_served(Some("https://my.page"), &allowed));
        assert!(is_served(Some("HTTPS://My.Page"), &allowed));
        assert!(!is_served(Some("https://my.page:8443"), &allowed));
        assert!(!is_served(Some("null"), &allowed));
    }
    #[test]
    fn a_notice_proposes_to_allow_an_origin_only_where_that_helps() {
        let notice = |origin: &str| judge_origin(origin, &[]).unwrap_err().to_string();
        assert!(notice("https://evil.example").contains("start with --allow-origin https://evil.example to"));
        let long = format!("https://{}.example", "a".repeat(100));
        for origin in ["null", "", "?", "file://", "https://a b", "https://\u{202e}x", &long] {
            assert!(!notice(origin).contains("--allow-origin"), "{origin}: {}", notice(origin));
        }
    }

    #[test]
    fn a_host_is_this_machine_or_was_allowed() {
        let own: IpAddr = "192.168.4.7".parse().unwrap();
        let allowed = ["https://my.page:8443/".to_owned(), "http://craft.lan".to_owned()];
        for host in [
            "localhost",
            "LocalHost:6761",
            "tauri.localhost",
            "127.0.0.1:6761",
            "127.8.8.8",
            "[::1]:6761",
            "192.168.4.7:6761",
            "[::ffff:192.168.4.7]:6761",
            "my.page",
            "craft.lan:6761",
        ] {
            assert_eq!(judge_host(host, own, &allowed), Ok(()), "{host}");
        }
        for host in [
            "",
            "evil.example",
            "evil.example:6761",
            "localhost.evil.example:6761",
            "192.168.4.8:6761",
            "0.0.0.0:6761",
            "127.0.0.1@evil.example",
            "localhost:6761:1",
            "http://localhost",
        ] {
            assert!(matches!(judge_host(host, own, &allowed), Err(Refusal::Host(_))), "{host}");
        }
    }
}
