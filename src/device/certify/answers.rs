//! What a device says, compared with what must come.

use super::say::{Say, Want, kind_name};
use super::verdict::{Trouble, ensure};
use crate::message::{Ack, Config, Message as _, Pong, Status, kind};

/// Something that the device said.
#[derive(Clone, Debug)]
pub(super) enum Heard {
    Status(Status),
    Pong(Pong),
    Reply(u8, Vec<u8>),
}

/// Compares answers with what was asked, in order; STATUS is none. Gives the CFG that came last.
pub(super) fn compare(
    news: &[Heard],
    asked: &[&Say],
    caps_payload: &[u8],
    n_ch: usize,
) -> Result<Option<Config>, Trouble> {
    let mut held = None;
    let mut answers = news
        .iter()
        .filter(|heard| !matches!(heard, Heard::Status(_)));
    for say in asked.iter().filter(|say| say.want.is_answered()) {
        let answer = answers.next();
        let is_right = match (say.want, answer) {
            (Want::Pong(token), Some(Heard::Pong(pong))) => pong.token == token,
            (_, Some(Heard::Reply(kind, payload))) => {
                is_answer(say, *kind, payload, caps_payload, n_ch)
            }
            _ => false,
        };
        if !is_right {
            let (name, right) = (kind_name(say.kind), describe(say));
            let came = answer.map_or_else(|| String::from("nothing"), Heard::describe);
            return Err(Trouble::Wrong(format!(
                "{name} was answered by {came}, not by {right}"
            )));
        }
        if let Want::Cfg(granted) = say.want {
            held = Some(granted);
        }
    }
    let surplus = answers.next().map(Heard::describe);
    ensure!(
        surplus.is_none(),
        "{} came unasked",
        surplus.unwrap_or_default()
    )?;
    Ok(held)
}

fn is_answer(say: &Say, kind: u8, payload: &[u8], caps_payload: &[u8], n_ch: usize) -> bool {
    match say.want {
        Want::Ack(code) => {
            let [low, high] = say.seq.to_le_bytes();
            kind == kind::ACK && payload.get(..4) == Some(&[say.kind, code, low, high])
        }
        Want::Caps(version, session) => {
            let mut expected = caps_payload.to_vec();
            if let Some(head) = expected.get_mut(4..9) {
                head[..4].copy_from_slice(&session.to_le_bytes());
                head[4] = version;
            }
            kind == kind::CAPS && payload == expected
        }
        Want::Cfg(held) => {
            let is_reserved_zero = payload.get(14..16) == Some(&[0, 0]);
            kind == kind::CFG && is_reserved_zero && Config::decode(payload, n_ch) == Some(held)
        }
        Want::Nothing | Want::Bad | Want::NoPacket | Want::Pong(_) => false,
    }
}

fn describe(say: &Say) -> String {
    match say.want {
        Want::Ack(code) => format!("ACK {code} of that packet"),
        Want::Caps(version, _) => format!("CAPS of version {version} as at first"),
        Want::Cfg(held) => format!("CFG with {}", describe_config(&held)),
        Want::Pong(_) => String::from("its PONG"),
        Want::Nothing | Want::Bad | Want::NoPacket => String::from("nothing"),
    }
}

impl Heard {
    pub(super) fn describe(&self) -> String {
        match self {
            Self::Status(status) => format!("STATUS of tick {}", status.tick),
            Self::Pong(pong) => format!("PONG {:08x}", pong.token),
            Self::Reply(kind::ACK, payload) => match Ack::decode(payload) {
                Some(ack) => format!(
                    "ACK {} of {} {}",
                    ack.code.code(),
                    kind_name(ack.kind),
                    ack.seq
                ),
                None => String::from("a short ACK"),
            },
            Self::Reply(kind::CFG, payload) => match Config::decode(payload, 32) {
                Some(held) => format!("CFG with {}", describe_config(&held)),
                None => String::from("a short CFG"),
            },
            Self::Reply(kind::CAPS, _) => String::from("other CAPS"),
            Self::Reply(kind, _) => format!("type {kind:02X}"),
        }
    }
}

fn describe_config(held: &Config) -> String {
    let [low, high] = held.comp_limit;
    format!(
        "mode {} flags {} hold {} ramp {} slew {} hv {} limits {low} {high} mask {:08x}",
        held.mode,
        held.flags,
        held.hold_ms,
        held.ramp_ms,
        held.slew,
        held.hv_dv,
        (0..32)
            .filter(|bit| held.mask.contains(*bit))
            .map(|bit| 1u32 << bit)
            .sum::<u32>()
    )
}
