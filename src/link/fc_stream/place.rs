//! The address of a flight controller: a serial port, a TCP port or a websocket, and the protocol at it.

use std::fmt;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::str::FromStr;

use tokio_tungstenite::tungstenite::http::Uri;

/// The default speed of a serial port, bit/s.
pub const DEFAULT_BAUD: u32 = 115_200;
/// The bits on a serial line for each byte: one start bit, eight data bits, one stop bit.
const BITS_PER_BYTE: u32 = 10;

/// The address of a flight controller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FcPlace {
    /// A serial port, including one over USB.
    Serial {
        device: PathBuf,
        /// The speed, bit/s.
        baud: u32,
    },
    Tcp {
        /// A name or an address. An IPv6 address has no brackets.
        host: String,
        port: u16,
    },
    WebSocket(
        /// The address, `ws://…` or `wss://…`.
        Uri,
    ),
    /// A UDP port of this machine, to which the craft sends MAVLink.
    Udp(SocketAddr),
    /// One of the others with a craft that speaks MAVLink.
    Mavlink(Box<Self>),
}

/// The error for a text that is not the address of a flight controller.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct FcPlaceError(String);

impl FcPlaceError {
    fn new(what: impl fmt::Display, example: impl fmt::Display) -> Self {
        const ALLOWED: &str = "allowed are serial:DEVICE[,BAUD], tcp:HOST:PORT and ws:URL";
        Self(format!("{what}; {ALLOWED}, such as {example}"))
    }

    fn of_mavlink(what: impl fmt::Display) -> Self {
        const ALLOWED: &str =
            "allowed after mavlink: are udp:[ADDRESS:]PORT, tcp:HOST:PORT and serial:DEVICE[,BAUD]";
        Self(format!("{what}; {ALLOWED}, such as mavlink:udp:14550"))
    }
}

impl FcPlace {
    /// Returns the capacity in bytes per second, or `None` if it exceeds every need.
    pub fn bytes_per_s(&self) -> Option<u32> {
        match self {
            Self::Serial { baud, .. } => Some(baud / BITS_PER_BYTE),
            Self::Tcp { .. } | Self::WebSocket(_) | Self::Udp(_) => None,
            Self::Mavlink(place) => place.bytes_per_s(),
        }
    }

    /// Returns `true` if the craft speaks MAVLink.
    pub fn speaks_mavlink(&self) -> bool {
        matches!(self, Self::Mavlink(_))
    }
}

impl FromStr for FcPlace {
    type Err = FcPlaceError;

    fn from_str(text: &str) -> Result<Self, FcPlaceError> {
        match text.split_once(':') {
            Some(("serial", device)) => serial(device),
            Some(("tcp", address)) => tcp(address),
            Some(("ws", rest)) if rest.starts_with("//") => websocket(text),
            Some(("ws", url)) => websocket(url),
            Some(("wss", _)) => websocket(text),
            Some(("mavlink", place)) => mavlink(place).map(|place| Self::Mavlink(Box::new(place))),
            Some(("udp", _)) => Err(FcPlaceError::of_mavlink(format!(
                "{text} does not name the protocol: only MAVLink comes over UDP"
            ))),
            _ if text.starts_with('/') => Err(FcPlaceError::new(
                format!("{text} does not say how to connect"),
                format!("serial:{text}"),
            )),
            _ => Err(FcPlaceError::new(
                format!("\"{text}\" is not a place of a flight controller"),
                "serial:/dev/ttyACM0",
            )),
        }
    }
}

fn mavlink(text: &str) -> Result<FcPlace, FcPlaceError> {
    match text.split_once(':') {
        Some(("udp", address)) => udp(address),
        Some(("tcp" | "serial", _)) => text.parse(),
        _ => {
            Err(FcPlaceError::of_mavlink(format!("\"{text}\" is not a place of a craft that speaks MAVLink")))
        }
    }
}

/// Reads the port, and the address of this machine at which it listens: the loopback without one.
fn udp(text: &str) -> Result<FcPlace, FcPlaceError> {
    let port = |text: &str| text.parse().ok().filter(|port: &u16| *port > 0);
    let on_loopback = || Some(SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), port(text)?));
    let address = on_loopback().or_else(|| text.parse().ok()).filter(|address| address.port() > 0);
    address.map(FcPlace::Udp).ok_or_else(|| {
        FcPlaceError::of_mavlink(format!("\"{text}\" is not a port (1 to 65535), alone or after an address"))
    })
}

fn serial(text: &str) -> Result<FcPlace, FcPlaceError> {
    let (device, baud) = text.rsplit_once(',').unwrap_or((text, ""));
    if device.is_empty() {
        return Err(FcPlaceError::new("the serial port is missing", "serial:/dev/ttyACM0"));
    }
    let baud = match baud.trim() {
        "" if device.len() == text.len() => DEFAULT_BAUD,
        digits => match digits.parse() {
            Ok(baud @ 300..=20_000_000) => baud,
            _ => {
                return Err(FcPlaceError::new(
                    format!("\"{digits}\" is not a speed of a serial port (300 to 20000000 bit/s)"),
                    format!("serial:{device},{DEFAULT_BAUD}"),
                ));
            }
        },
    };
    Ok(FcPlace::Serial { device: device.into(), baud })
}

fn tcp(text: &str) -> Result<FcPlace, FcPlaceError> {
    const EXAMPLE: &str = "tcp:127.0.0.1:5761";
    let (host, port) = text
        .rsplit_once(':')
        .ok_or_else(|| FcPlaceError::new(format!("tcp:{text} has no port"), format!("tcp:{text}:5761")))?;
    let in_brackets = host.strip_prefix('[').and_then(|host| host.strip_suffix(']'));
    let host = match in_brackets {
        Some(address) => address,
        None if host.contains(':') => {
            return Err(FcPlaceError::new(
                format!("the address {host} needs brackets"),
                format!("tcp:[{host}]:{port}"),
            ));
        }
        None => host,
    };
    if host.is_empty() || host.contains(char::is_whitespace) {
        return Err(FcPlaceError::new(format!("tcp:{text} has no host"), EXAMPLE));
    }
    match port.parse() {
        Ok(port @ 1..) => Ok(FcPlace::Tcp { host: host.to_owned(), port }),
        _ => Err(FcPlaceError::new(format!("\"{port}\" is not a port (1 to 65535)"), EXAMPLE)),
    }
}

fn websocket(url: &str) -> Result<FcPlace, FcPlaceError> {
    const EXAMPLE: &str = "ws://127.0.0.1:6761";
    let with_scheme = if url.contains("://") { url.to_owned() } else { format!("ws://{url}") };
    let problem = |what: String| FcPlaceError::new(what, EXAMPLE);
    let uri: Uri =
        with_scheme.parse().map_err(|error| problem(format!("\"{url}\" is not a URL ({error})")))?;
    if !matches!(uri.scheme_str(), Some("ws" | "wss")) {
        return Err(problem(format!("\"{url}\" is not a websocket URL (ws:// or wss://)")));
    }
    if uri.host().is_none_or(str::is_empty) {
        return Err(problem(format!("\"{url}\" names no host")));
    }
    if uri.scheme_str() == Some("wss") && !cfg!(feature = "tls") {
        let why = "this program is built without TLS, which wss:// needs: build it with `--features tls`";
        return Err(FcPlaceError(why.to_owned()));
    }
    Ok(FcPlace::WebSocket(uri))
}

impl fmt::Display for FcPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Serial { device, baud: DEFAULT_BAUD } => write!(f, "serial:{}", device.display()),
            Self::Serial { device, baud } => write!(f, "serial:{},{baud}", device.display()),
            Self::Tcp { host, port } if host.contains(':') => write!(f, "tcp:[{host}]:{port}"),
            Self::Tcp { host, port } => write!(f, "tcp:{host}:{port}"),
            // Without a path, the address would end in a slash.
            Self::WebSocket(uri) if uri.path_and_query().is_none_or(|path| path == "/") => {
                write!(f, "{}", uri.to_string().trim_end_matches('/'))
            }
            Self::WebSocket(uri) => write!(f, "{uri}"),
            Self::Udp(address) if address.ip() == IpAddr::V4(Ipv4Addr::LOCALHOST) => {
                write!(f, "udp:{}", address.port())
            }
            Self::Udp(address) => write!(f, "udp:{address}"),
            Self::Mavlink(place) => write!(f, "mavlink:{place}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str) -> String {
        text.parse::<FcPlace>().unwrap_err().to_string()
    }

    #[test]
    fn places_are_read_and_written() {
        for (text, shown) in [
            ("serial:/dev/ttyACM0", "serial:/dev/ttyACM0"),
            ("serial:/dev/ttyACM0,115200", "serial:/dev/ttyACM0"),
            ("serial:/dev/serial/by-id/usb-a,b-if00,9600", "serial:/dev/serial/by-id/usb-a,b-if00,9600"),
            ("tcp:localhost:5761", "tcp:localhost:5761"),
            ("tcp:[::1]:5761", "tcp:[::1]:5761"),
            ("ws:localhost:6761", "ws://localhost:6761"),
            ("ws:ws://localhost:6761/", "ws://localhost:6761"),
            ("ws://10.0.0.1/fc?x=1", "ws://10.0.0.1/fc?x=1"),
            #[cfg(feature = "tls")]
            ("ws:wss://craft.example/fc", "wss://craft.example/fc"),
            #[cfg(feature = "tls")]
            ("wss://craft.example", "wss://craft.example"),
            ("mavlink:udp:14550", "mavlink:udp:14550"),
            ("mavlink:udp:127.0.0.1:14550", "mavlink:udp:14550"),
            ("mavlink:udp:0.0.0.0:14550", "mavlink:udp:0.0.0.0:14550"),
            ("mavlink:udp:[::1]:14550", "mavlink:udp:[::1]:14550"),
            ("mavlink:tcp:localhost:5760", "mavlink:tcp:localhost:5760"),
            ("mavlink:serial:/dev/ttyUSB0,57600", "mavlink:serial:/dev/ttyUSB0,57600"),
        ] {
            let place: FcPlace = text.parse().unwrap_or_else(|error| panic!("{text}: {error}"));
            assert_eq!(place.to_string(), shown, "{text}");
            assert_eq!(shown.parse(), Ok(place), "{text}");
        }
    }

    #[test]
    fn a_refusal_says_what_is_allowed() {
        for (text, part) in [
            ("/dev/ttyUSB1", "such as serial:/dev/ttyUSB1"),
            ("COM3", "\"COM3\" is not a place"),
            ("", "\"\" is not a place"),
            ("serial:", "the serial port is missing"),
            ("serial:/dev/ttyACM0,", "\"\" is not a speed"),
            ("serial:/dev/ttyACM0,fast", "such as serial:/dev/ttyACM0,115200"),
            ("serial:/dev/ttyACM0,0", "300 to 20000000"),
            ("tcp:localhost", "such as tcp:localhost:5761"),
            ("tcp::5761", "has no host"),
            ("tcp:::1:5761", "such as tcp:[::1]:5761"),
            ("tcp:localhost:0", "1 to 65535"),
            ("tcp:localhost:70000", "1 to 65535"),
            ("ws:", "not a URL"),
            ("ws:http://craft.example", "ws:// or wss://"),
            ("ws://", "\"ws://\""),
        ] {
            let reported = refusal(text);
            assert!(reported.contains(part), "{text}: {reported}");
            assert!(
                reported.contains("allowed are serial:DEVICE[,BAUD], tcp:HOST:PORT and ws:URL"),
                "{reported}"
            );
        }
    }

    #[test]
    fn a_refusal_of_a_mavlink_place_says_what_is_allowed_there() {
        for (text, part) in [
            ("udp:14550", "does not name the protocol"),
            ("mavlink:14550", "\"14550\" is not a place"),
            ("mavlink:ws://localhost:1", "is not a place"),
            ("mavlink:mavlink:udp:14550", "is not a place"),
            ("mavlink:udp:0", "1 to 65535"),
            ("mavlink:udp:localhost:14550", "alone or after an address"),
        ] {
            let reported = refusal(text);
            assert!(reported.contains(part) && reported.contains("such as mavlink:udp:14550"), "{reported}");
        }
    }

    #[cfg(not(feature = "tls"))]
    #[test]
    fn a_place_with_tls_is_refused_with_the_way_to_get_it() {
        for text in ["wss://craft.example", "ws:wss://craft.example/fc"] {
            assert!(refusal(text).ends_with("build it with `--features tls`"), "{}", refusal(text));
        }
        assert!(refusal("wss://").contains("is not a URL"), "{}", refusal("wss://"));
    }

    #[test]
    fn a_serial_line_carries_a_tenth_of_its_speed() {
        let place = |text: &str| text.parse::<FcPlace>().unwrap();
        assert_eq!(place("serial:/dev/ttyACM0").bytes_per_s(), Some(11_520));
        assert_eq!(place("tcp:localhost:1").bytes_per_s(), None);
    }

    proptest::proptest! {
        #[test]
        fn any_text_is_read_or_refused_and_what_is_read_is_shown_as_it_is_typed(
            text in "(mavlink:)?(udp:|serial:|tcp:|ws:|wss://|ws://)?[a-z0-9/.:,\\[\\]? @é-]{0,30}",
        ) {
            if let Ok(place) = text.parse::<FcPlace>() {
                proptest::prop_assert_eq!(place.to_string().parse(), Ok(place));
            }
        }
    }
}
