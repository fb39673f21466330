//! Several requests in one message.

use super::{Call, Refused, table};
use crate::msp::{Access, PaddedReader, Writer};

/// The most bytes of all answers.
const REPLY_MAX: usize = 512;

/// Answers requests that need no payload of their own, each answer after its length. Answers that do not fit are left
/// out, and the client requests them again.
pub(super) fn multiple(call: &mut Call<'_>) -> Result<(), Refused> {
    let codes = call.request.all();
    if codes.is_empty() {
        return Err(Refused);
    }
    let mut answers: Vec<u8> = Vec::with_capacity(REPLY_MAX);
    for &code in codes {
        let message = table::find(u16::from(code))
            .filter(|message| message.kind.access == Access::Read)
            .ok_or(Refused)?;
        let mut question = Call {
            configuration: call.configuration,
            facts: call.facts,
            request: PaddedReader::new(&[]),
            reply: Writer::default(),
            action: None,
            notice: None,
        };
        message.handler.run(&mut question)?;
        let answer = question.reply.into_bytes();
        let Ok(length) = u8::try_from(answer.len()) else { return Err(Refused) };
        if answers.len() + 1 + answer.len() > REPLY_MAX {
            break;
        }
        answers.push(length);
        answers.extend(answer);
    }
    call.reply.bytes(&answers);
    Ok(())
}
