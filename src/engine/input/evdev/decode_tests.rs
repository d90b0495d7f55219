//! Reports as devices make them, event by event.

use super::code::{
    ABS, ABS_PRESSURE, ABS_X, ABS_Y, KEY, MT_ID, MT_SLOT, MT_X, MT_Y, SYN, SYN_DROPPED, SYN_REPORT,
    TOUCH,
};
use super::*;

const PEN: u16 = 0x140;
const END: (u16, u16, i32) = (SYN, SYN_REPORT, 0);

/// What a device in this state says with these events, 8 ms a report.
fn said(contact: Contact, events: &[(u16, u16, i32)]) -> Vec<Report> {
    let mut decoder = Decoder::new(contact, State::NOTHING);
    let mut time_us = 0;
    let mut reports = Vec::new();
    for &(kind, code, value) in events {
        let event = Event {
            time_us,
            kind,
            code,
            value,
        };
        time_us += if (kind, code) == (SYN, SYN_REPORT) {
            8000
        } else {
            0
        };
        decoder.take(event, &mut |report| reports.push(report));
    }
    reports
}

fn at(time_us: i64, x: i32, y: i32) -> Report {
    Report::At {
        finger: 0,
        time_us,
        at: [x, y],
    }
}

#[test]
fn a_pen_is_heard_while_it_touches_and_its_lift_is_told_once() {
    let events = [
        (KEY, PEN, 1),
        (ABS, ABS_X, 10),
        (ABS, ABS_Y, 20),
        END, // hovers
        (KEY, TOUCH, 1),
        END,
        (ABS, ABS_X, 11),
        END,
        (KEY, TOUCH, 0),
        END,
        (ABS, ABS_X, 12),
        END, // hovers away
        (KEY, PEN, 0),
        END,
    ];
    let expected = [at(8000, 10, 20), at(16_000, 11, 20), Report::Lifted(0)];
    assert_eq!(said(Contact::Button, &events), expected);
}

#[test]
fn a_tool_out_of_range_is_a_lift_whatever_the_button_says() {
    let events = [(KEY, PEN, 1), (KEY, TOUCH, 1), END, (KEY, PEN, 0), END, END];
    assert_eq!(
        said(Contact::Button, &events),
        [at(0, 0, 0), Report::Lifted(0)]
    );
}

#[test]
fn pressure_above_nothing_is_contact_where_there_is_no_button() {
    let events = [
        (ABS, ABS_X, 5),
        END,
        (ABS, ABS_PRESSURE, 3),
        END,
        (ABS, ABS_PRESSURE, 0),
        END,
    ];
    assert_eq!(
        said(Contact::Pressure, &events),
        [at(8000, 5, 0), Report::Lifted(0)]
    );
    assert_eq!(said(Contact::Always, &events).len(), 3);
}

#[test]
fn each_finger_keeps_its_number_and_none_takes_another_s() {
    let events = [
        (ABS, MT_SLOT, 0),
        (ABS, MT_ID, 70),
        (ABS, MT_X, 1),
        (ABS, MT_Y, 2),
        END,
        (ABS, MT_SLOT, 1),
        (ABS, MT_ID, 71),
        (ABS, MT_X, 500),
        END, // a second finger
        (ABS, MT_SLOT, 0),
        (ABS, MT_ID, -1),
        END, // the first lifts, the second stays
        (ABS, MT_SLOT, 1),
        (ABS, MT_X, 501),
        END,
        (ABS, MT_SLOT, 0),
        (ABS, MT_ID, 72),
        (ABS, MT_X, 9),
        END, // a new first finger
    ];
    let reports = said(Contact::Slots, &events);
    let of_second = |report: &Report| {
        matches!(report, Report::At { finger: 1, .. }) || *report == Report::Lifted(1)
    };
    let (second, first): (Vec<Report>, Vec<Report>) = reports.into_iter().partition(of_second);
    let expected = [
        at(0, 1, 2),
        at(8000, 1, 2),
        Report::Lifted(0),
        at(32_000, 9, 2),
    ];
    assert_eq!(first, expected);
    let of_second = |(time_us, x)| Report::At {
        finger: 1,
        time_us,
        at: [x, 0],
    };
    let expected = [(8000, 500), (16_000, 500), (24_000, 501), (32_000, 501)];
    assert_eq!(second, expected.map(of_second));
}

#[test]
fn a_finger_that_is_replaced_within_a_report_lifts_before_it_touches() {
    let events = [
        (ABS, MT_ID, 1),
        END,
        (ABS, MT_ID, 2),
        (ABS, MT_X, 900),
        END,
        END,
    ];
    let reports = said(Contact::Slots, &events);
    assert_eq!(reports, [at(0, 0, 0), Report::Lifted(0)]);
}

#[test]
fn after_a_loss_nothing_is_believed_until_the_state_is_known() {
    let mut decoder = Decoder::new(Contact::Button, State::NOTHING);
    let take = |decoder: &mut Decoder, kind, code, value| {
        let (mut said, time_us) = (None, 1);
        let event = Event {
            time_us,
            kind,
            code,
            value,
        };
        decoder.take(event, &mut |report| said = Some(report));
        said
    };
    take(&mut decoder, KEY, TOUCH, 1);
    assert_eq!(take(&mut decoder, SYN, SYN_REPORT, 0), Some(at(1, 0, 0)));
    take(&mut decoder, SYN, SYN_DROPPED, 0);
    take(&mut decoder, ABS, ABS_X, 999);
    assert_eq!(take(&mut decoder, SYN, SYN_REPORT, 0), Some(Report::Lost));
    let state = State {
        at: [7, 8],
        is_touching: true,
        ..State::NOTHING
    };
    decoder.resume(state);
    assert_eq!(take(&mut decoder, SYN, SYN_REPORT, 0), Some(at(1, 7, 8)));
}

#[test]
fn fingers_that_are_down_at_the_start_are_followed() {
    let mut state = State::NOTHING;
    state.slots[3] = Slot { id: 9, at: [4, 5] };
    state.slots[6] = Slot { id: 2, at: [6, 7] };
    let mut decoder = Decoder::new(Contact::Slots, state);
    let end = Event {
        time_us: 0,
        kind: SYN,
        code: SYN_REPORT,
        value: 0,
    };
    let mut said = Vec::new();
    decoder.take(end, &mut |report| said.push(report));
    let second = Report::At {
        finger: 1,
        time_us: 0,
        at: [6, 7],
    };
    assert_eq!(said, [at(0, 4, 5), second]);
}

#[test]
fn events_are_read_from_whole_pieces_of_bytes() {
    let mut bytes = Vec::new();
    for (s, us, kind, code, value) in [(3_i64, 250_i64, 3_u16, 1_u16, -5_i32), (4, 0, 0, 0, 0)] {
        bytes.extend(s.to_ne_bytes());
        bytes.extend(us.to_ne_bytes());
        bytes.extend(kind.to_ne_bytes());
        bytes.extend(code.to_ne_bytes());
        bytes.extend(value.to_ne_bytes());
    }
    bytes.extend([1, 2, 3]);
    let events: Vec<Event> = Event::read(&bytes).collect();
    assert_eq!(events.len(), 2);
    let first = Event {
        time_us: 3_000_250,
        kind: 3,
        code: 1,
        value: -5,
    };
    assert_eq!(events[0], first);
}

proptest::proptest! {
    #[test]
    fn no_stream_of_events_makes_the_decoder_fail(
        bytes in proptest::collection::vec(0_u8.., 0..2000), way in 0..4,
    ) {
        let ways = [Contact::Slots, Contact::Button, Contact::Pressure, Contact::Always];
        let mut decoder = Decoder::new(ways[usize::try_from(way).unwrap()], State::NOTHING);
        for mut event in Event::read(&bytes) {
            // Random codes would hardly ever mean anything.
            event.kind %= 4;
            event.code %= 0x150;
            decoder.take(event, &mut |_| {});
        }
    }
}
