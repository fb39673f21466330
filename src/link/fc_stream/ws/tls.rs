//! TLS for websockets, with the certificates that this machine trusts.

use std::io;
use std::sync::Arc;

use rustls::crypto::ring::default_provider;
use rustls::{ClientConfig, RootCertStore};
use tokio_tungstenite::Connector;
use tokio_tungstenite::tungstenite::http::Uri;

/// Returns what encrypts the connection to an address, or `None` if that is not wanted.
///
/// # Errors
/// Returns an error if this machine trusts no certificate.
pub(super) async fn connector(uri: &Uri) -> io::Result<Option<Connector>> {
    if uri.scheme_str() != Some("wss") {
        return Ok(None);
    }
    let load = tokio::task::spawn_blocking(|| {
        let mut roots = RootCertStore::empty();
        roots.add_parsable_certificates(rustls_native_certs::load_native_certs().certs);
        roots
    });
    let roots = load.await?;
    if roots.is_empty() {
        return Err(io::Error::other("this machine has no trusted certificates (package ca-certificates)"));
    }
    let config = ClientConfig::builder_with_provider(Arc::new(default_provider()))
        .with_safe_default_protocol_versions()
        .map_err(io::Error::other)?
        .with_root_certificates(roots)
        .with_no_client_auth();
    Ok(Some(Connector::Rustls(Arc::new(config))))
}

/// Returns an error of TLS as part of a sentence, or `None` for another error.
pub(super) fn refusal(error: &io::Error) -> Option<String> {
    match error.get_ref()?.downcast_ref::<rustls::Error>()? {
        rustls::Error::InvalidCertificate(why) => Some(format!("its certificate is not trusted ({why})")),
        error => Some(format!("TLS fails: {error}")),
    }
}
