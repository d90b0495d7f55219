//! A lie as people write it, and the table of all of them.

use std::fmt;

use super::declared::{Act, Declared, Takes};
use super::fields::FIELDS;
use super::rules::{RULES, Rule};
use crate::framing::LARGEST_BODY;
use crate::message::DeviceState;

/// One thing that the firmware of an emulated device says although it is not so, or a rule of the
/// protocol that it breaks.
///
/// Written as `NAME`, `NAME=VALUE`, and with `@TICK` at the end from that
/// tick of the device on: `caps.rows=5`, `status.tick=-1`, `no-ramp`, `status.faults=64@80`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FirmwareLie {
    pub(super) declared: &'static Declared,
    pub(super) value: i64,
    /// Whether the value is added to what is true, rather than said in its place.
    pub(super) is_added: bool,
    pub(super) from_tick: u32,
}

impl FirmwareLie {
    /// All lies of the table, with each of the values that they are to be tried with.
    pub fn examples() -> impl Iterator<Item = Self> {
        declared().flat_map(|lie| {
            let bare = (lie.takes == Takes::Nothing).then(|| lie.name.to_owned());
            let valued = lie
                .examples
                .iter()
                .map(|value| format!("{}={value}", lie.name));
            bare.into_iter()
                .chain(valued)
                .filter_map(|text| Self::read(&text).ok())
        })
    }

    /// Reads a lie as people write it.
    ///
    /// # Errors
    /// One line that says what there is instead.
    pub fn read(text: &str) -> Result<Self, String> {
        let (lie, from) = match text.split_once('@') {
            Some((lie, from)) => (lie, Some(from)),
            None => (text, None),
        };
        let (name, value) = match lie.split_once('=') {
            Some((name, value)) => (name, Some(value)),
            None => (lie, None),
        };
        let declared = declared()
            .find(|declared| declared.name == name)
            .ok_or_else(|| unknown(name))?;
        let (value, is_added) = declared
            .value(value)
            .ok_or_else(|| format!("\"{text}\": write {}", declared.form()))?;
        let from_tick = match from {
            Some(tick) => tick.parse().ok(),
            None => Some(0),
        };
        let from_tick = from_tick
            .ok_or_else(|| format!("\"{text}\": write a tick of the device after the @"))?;
        Ok(Self {
            declared,
            value,
            is_added,
            from_tick,
        })
    }

    /// Its name, without its value.
    pub fn name(&self) -> &'static str {
        self.declared.name
    }

    /// The rule that it breaks or the field that it is about, and what the device does: a line for
    /// people.
    pub fn help(&self) -> &'static str {
        self.declared.help
    }

    /// The table as text: a line for each lie.
    pub fn listing() -> String {
        let lines = declared().map(|lie| format!("{:<32}{}\n", lie.form(), lie.help));
        let how = "NUMBER stands in place of what is true, +NUMBER and -NUMBER are added to it; \
                   @TICK at the end: from that tick of the device on\n";
        std::iter::once(how.to_owned()).chain(lines).collect()
    }

    /// Its value, if it breaks this rule at this tick.
    fn breaks(&self, rule: Rule, tick: u32) -> Option<u64> {
        let is_so = self.declared.act == Act::Rule(rule) && tick >= self.from_tick;
        is_so.then(|| self.value.unsigned_abs())
    }
}

impl fmt::Display for FirmwareLie {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.declared.name)?;
        match (self.declared.takes, self.is_added) {
            (Takes::Nothing, _) => {}
            (_, true) => write!(f, "={:+}", self.value)?,
            (_, false) => write!(f, "={}", self.value)?,
        }
        if self.from_tick > 0 {
            write!(f, "@{}", self.from_tick)?;
        }
        Ok(())
    }
}

/// The value of the first lie that breaks a rule at a tick; 0 where it takes none.
pub(crate) fn value(lies: &[FirmwareLie], tick: u32, rule: Rule) -> Option<u64> {
    lies.iter().find_map(|lie| lie.breaks(rule, tick))
}

/// The largest body and the frames that fit, where CAPS say these.
pub(crate) fn room(lies: &[FirmwareLie], max_body: u16, queue: u8) -> (usize, u8) {
    let value = |rule| value(lies, 0, rule);
    let less = value(Rule::ShorterBody).map_or(0, |less| usize::try_from(less).unwrap_or(0));
    let body = usize::from(max_body).saturating_sub(less);
    let more = value(Rule::QueueDeep).or_else(|| value(Rule::FramesDelayed).map(|_| 1));
    let more = u8::try_from(more.unwrap_or(0)).unwrap_or(u8::MAX);
    let takes_all = value(Rule::OversizeAccepted).is_some();
    (
        if takes_all { LARGEST_BODY } else { body },
        queue.saturating_add(more),
    )
}

/// The state after boot.
pub(crate) fn boot_state(lies: &[FirmwareLie]) -> DeviceState {
    match value(lies, 0, Rule::ArmedAtStart) {
        Some(_) => DeviceState::Armed,
        None => DeviceState::Idle,
    }
}

pub(super) fn declared() -> impl Iterator<Item = &'static Declared> {
    FIELDS.iter().chain(RULES)
}

/// What there is in place of a name that nothing is called: the fields of that message, or all
/// messages and rules.
fn unknown(name: &str) -> String {
    let message = name.split_once('.').map(|(message, _)| message);
    let is_near = |known: &str| match message {
        Some(message) => known.split_once('.').is_some_and(|(of, _)| of == message),
        None => !known.contains('.'),
    };
    let known: Vec<&str> = declared()
        .map(|lie| lie.name)
        .filter(|known| is_near(known))
        .collect();
    if known.is_empty() {
        return format!(
            "\"{name}\" is no lie: fields begin with caps., cfg., ack., status., fault. or pong."
        );
    }
    format!("\"{name}\" is no lie; choose of {}", known.join(", "))
}
