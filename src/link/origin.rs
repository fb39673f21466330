//! Which web pages may reach the craft.
//!
//! A browser lets any page on the net open a websocket to this machine and names the page's origin. Without a check a
//! stranger's page could fly the craft.

/// The page of the hosted App.
const APP: &str = "https://app.betaflight.com";

/// Whether a page of this origin is served. Clients that are no browsers name none.
#[must_use]
pub(super) fn is_served(origin: Option<&str>, allowed: &[String]) -> bool {
    let Some(origin) = origin else { return true };
    let origin = origin.trim().trim_end_matches('/');
    origin.eq_ignore_ascii_case(APP)
        || allowed.iter().any(|allowed| allowed.trim_end_matches('/').eq_ignore_ascii_case(origin))
        || host(origin).is_some_and(is_loopback)
}

/// The host of `scheme://host` or `scheme://host:port`; `None` for anything else.
fn host(origin: &str) -> Option<&str> {
    let (scheme, authority) = origin.split_once("://")?;
    let in_scheme = |byte: u8| byte.is_ascii_alphanumeric() || b"+-.".contains(&byte);
    if scheme.is_empty() || !scheme.bytes().all(in_scheme) {
        return None;
    }
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

/// This machine by name or address. Names below `localhost` belong to this machine too; the App's desktop and mobile
/// shells use them, under schemes of their own.
fn is_loopback(host: &str) -> bool {
    let host = host.to_ascii_lowercase();
    host == "localhost"
        || host.ends_with(".localhost")
        || host.parse::<std::net::IpAddr>().is_ok_and(|address| address.is_loopback())
}

#[cfg(test)]
mod tests {
    use super::is_served;

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
}
