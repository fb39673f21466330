//! The lines of standard input for `--plain`.

use std::io::{self, BufRead};

use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};

use crate::process::error::AppError;

/// The longest line, bytes.
const LONGEST: u64 = 1 << 20;

/// Reads the lines as they come, until the input ends. A line that cannot be read gives a sentence instead. The reading
/// thread ends with the program.
pub(super) fn read() -> Result<UnboundedReceiver<Result<String, String>>, AppError> {
    let (sender, lines) = unbounded_channel();
    let read = move || {
        let mut input = io::stdin().lock();
        for number in 1.. {
            let Some(line) = next(&mut input, number) else { return };
            if sender.send(line).is_err() {
                return;
            }
        }
    };
    std::thread::Builder::new()
        .name("input".to_owned())
        .spawn(read)
        .map_err(|error| AppError::environment(format!("cannot start a thread: {error}")))?;
    Ok(lines)
}

/// Reads the next line without its end; `None` at the end of the input.
fn next(input: &mut impl BufRead, number: u64) -> Option<Result<String, String>> {
    let mut line = Vec::new();
    let ended = match read_part(input, &mut line) {
        Ok(_) if line.is_empty() => return None,
        Ok(ended) => ended,
        Err(_) => return None,
    };
    if !ended && line.len() as u64 > LONGEST {
        let mut rest = Vec::new();
        while !read_part(input, &mut rest).ok()? && !rest.is_empty() {
            rest.clear();
        }
        let most = LONGEST >> 20;
        return Some(Err(format!("line {number} of the input is longer than {most} MiB: it is skipped.")));
    }
    if ended {
        line.pop();
        line.pop_if(|last| *last == b'\r');
    }
    let not_text = |_| format!("line {number} of the input is not UTF-8 text: it is skipped.");
    Some(String::from_utf8(line).map_err(not_text))
}

/// Reads up to the end of the line, or slightly more than the longest line. Returns `true` at the end of the line.
fn read_part(input: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<bool> {
    io::Read::take(input, LONGEST + 1).read_until(b'\n', line)?;
    Ok(line.last() == Some(&b'\n'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(input: &[u8]) -> Vec<Result<String, String>> {
        let mut input = input;
        (1..).map_while(|number| next(&mut input, number)).collect()
    }

    #[test]
    fn bytes_that_are_no_text_and_long_lines_are_skipped_and_the_rest_is_read() {
        let long = vec![b'x'; 3 * LONGEST as usize];
        let input = [b"one\r\n\xff\n\ntwo\n".as_slice(), &long, b"\nthree"].concat();
        let read = lines(&input);
        assert_eq!(read.len(), 6);
        let text = |at: usize| read[at].as_deref().ok();
        assert_eq!([text(0), text(2), text(3), text(5)], [Some("one"), Some(""), Some("two"), Some("three")]);
        assert!(read[1].as_ref().is_err_and(|error| error.starts_with("line 2 of the input is not UTF-8")));
        assert!(read[4].as_ref().is_err_and(|error| error.starts_with("line 5 of the input is longer than")));
        let longest = vec![b'x'; LONGEST as usize];
        assert_eq!(lines(&[&longest[..], b"\n"].concat())[0].as_ref().map(String::len), Ok(longest.len()));
    }
}
