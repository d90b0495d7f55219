/* hbp_core.c - a device of the protocol HBP v1 as a state machine. See hbp_core.h.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * Everything that keeps a finger safe (lease, hold and ramp, arming, STOP, faults) runs on the 1 ms
 * clock, so silence comes at a fixed age of the last frame whatever the phase of the tick.
 */
#include "hbp_core.h"
#include "hbp_defects.h" /* DEFECT(...) is 0 in every build but those of tests */

enum { /* message types */
    HELLO = 0x01, CONFIG, ARM, FRAME, STOP, PING, CLEAR, SAMPLES, IDENT,
    FIRST_OF_DEVICE = 0x80, CAPS, CFG, ACK, STATUS, FAULT, PONG
};
enum { ACK_OK, BAD_SESSION, WRONG_STATE, QUEUE_FULL, UNKNOWN_TYPE, OUT_OF_RANGE, FAULTED };
enum { NO_REPLY = 0x100, NOT_VALID = 0x101 }; /* what a packet leads to beside an ACK code */
enum { TEXT_EMPTY, TEXT_GROWING, TEXT_OVERSIZE };

enum { VERSION = 1, LONGEST_SILENCE_MS = 100, LONGEST_IDENT_MS = 1000, FAULT_PERIOD_MS = 100 };
enum { STALE_SAMPLES = 160, PROMPT_SAMPLES = 4 }; /* 20 ms, and half a ms, between two steps */
#define MAGIC 0x31504248u /* "HBP1" */
#define ARM_KEY 0xA5C30F96u
#define NEXT_TICK 0xFFFFFFFFu
/* Lengths of header, CRC and payloads, and of CAPS with the longest name. What a device sends is
 * below 254 bytes, so that COBS never needs a full block. */
enum { HEADER = 4, CRC = 4, CONFIG_LENGTH = 16 + 4 * HBP_MASK_WORDS };
enum { FRAME_LENGTH = 4 + 4 * HBP_CHANNELS, LARGEST_SENT = HEADER + 64 + 32 + CRC };

/* ---- Numbers ----------------------------------------------------------------------------- */
static uint16_t get16(const uint8_t *p) { return (uint16_t)(p[0] | (uint16_t)p[1] << 8); }
static uint32_t get32(const uint8_t *p) { return get16(p) | (uint32_t)get16(p + 2) << 16; }
static uint16_t min16(uint32_t a, uint16_t b) { return a < b ? (uint16_t)a : b; }

/* CRC-32/ISO-HDLC: "123456789" gives CBF43926. A board with a CRC unit may use that instead. */
static uint32_t crc32(const uint8_t *bytes, uint16_t length) {
    uint32_t crc = 0xFFFFFFFFu;
    for (; length > 0; length--) {
        int bit;
        crc ^= *bytes++;
        for (bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
    }
    return ~crc;
}

/* A quarter of a sine, peak 2047 * 16, so that 65535 * peak shifted by 20 bits is 2047 steps of a
 * 12-bit converter. 40 Hz has 200 samples a period, 320 Hz 25: both begin anew at every tick. */
static int32_t sine(unsigned i) {
    static const uint16_t quarter[51] = {
        0, 1029, 2057, 3082, 4105, 5124, 6137, 7145, 8145, 9138, 10121, 11094, 12057, 13007,
        13945, 14869, 15778, 16672, 17549, 18409, 19251, 20074, 20877, 21659, 22420, 23159,
        23875, 24568, 25236, 25879, 26497, 27089, 27653, 28191, 28701, 29182, 29635, 30058,
        30452, 30816, 31149, 31452, 31723, 31963, 32172, 32349, 32494, 32607, 32687, 32736,
        32752
    };
    int32_t value = quarter[i % 100 <= 50 ? i % 100 : 100 - i % 100];
    return i < 100 ? value : -value;
}

/* ---- Sending ----------------------------------------------------------------------------- */
typedef struct {
    uint8_t bytes[LARGEST_SENT];
    uint16_t length;
} writer;

static void put8(writer *w, uint32_t value) { w->bytes[w->length++] = (uint8_t)(value & 255); }
static void put16(writer *w, uint32_t value) { put8(w, value); put8(w, value >> 8); }
static void put32(writer *w, uint32_t value) { put16(w, value); put16(w, value >> 16); }

static void begin(hbp_device *d, writer *w, uint8_t type) {
    w->length = 0;
    put8(w, type); put8(w, 0); put16(w, d->next_seq++);
}

/* CRC, COBS, delimiters, and out. */
static void finish(hbp_device *d, writer *w) {
    uint8_t wire[LARGEST_SENT + 3];
    uint16_t code_at = 1, length = 2, i;
    put32(w, crc32(w->bytes, w->length));
    wire[0] = 0;
    for (i = 0; i < w->length; i++, length++) {
        wire[length] = w->bytes[i];
        if (w->bytes[i] == 0) {
            wire[code_at] = (uint8_t)(length - code_at);
            code_at = length;
        }
    }
    wire[code_at] = (uint8_t)(length - code_at);
    wire[length++] = 0;
    d->port.send(d->port.context, wire, length);
}

static void send_caps(hbp_device *d, const uint8_t *hello, uint8_t version) {
    static const char default_uid[] = HBP_UID, name[] = HBP_NAME;
    const uint8_t *uid = d->port.uid ? d->port.uid : (const uint8_t *)default_uid;
    unsigned i;
    writer w;
    begin(d, &w, CAPS);
    put32(&w, MAGIC); put32(&w, get32(hello + 4)); put8(&w, version);
    put8(&w, 2); put16(&w, HBP_CHANNELS); put8(&w, HBP_ROWS); put8(&w, HBP_COLS);
    put16(&w, HBP_PITCH_UM); put32(&w, HBP_MS_PER_TICK * 1000u); put8(&w, HBP_QUEUE);
    put8(&w, 12); put16(&w, HBP_IDENT ? 5 : 1); put32(&w, HBP_FS_MV);
    put16(&w, HBP_HV_MAX_DV); put16(&w, HBP_SLEW_MAX); put16(&w, HBP_MAX_BODY); put16(&w, 8000);
    put32(&w, 40000); put32(&w, 320000); put16(&w, HBP_LIMIT_40); put16(&w, HBP_LIMIT_320);
    for (i = 0; i < 12; i++) put8(&w, uid[i]);
    put8(&w, 1); put8(&w, 0); put8(&w, 0); put8(&w, sizeof name - 1);
    for (i = 0; i + 1u < sizeof name; i++) put8(&w, (uint8_t)name[i]);
    finish(d, &w);
}

static void send_status(hbp_device *d) {
    int lease_lost = d->descending && d->descent_end == HBP_IDLE;
    hbp_measured measured = { 0, 0, 0 };
    /* A frame that came within a step has not seen that step whole. */
    uint32_t age = d->has_frame ? d->age_steps - (d->age_phase_us > 0) : 0xFFFF, queued = 0, i;
    writer w;
    d->port.measure(d->port.context, &measured);
    for (i = 0; i < HBP_QUEUE; i++) queued += d->queue[i].full;
    begin(d, &w, STATUS);
    put32(&w, d->tick); put32(&w, d->dev_us); put16(&w, d->has_seq ? d->last_seq : 0);
    put8(&w, d->state); put8(&w, queued); put16(&w, d->underrun); put16(&w, d->late);
    put16(&w, d->dup); put16(&w, d->bad); put16(&w, d->clipped); put16(&w, measured.hv_dv);
    put16(&w, measured.i_ma); put16(&w, (uint16_t)measured.temp_cdeg);
    put16(&w, d->faults | (lease_lost ? (uint32_t)HBP_LEASE_LOST : 0u));
    put16(&w, min16(age, 0xFFFF)); put32(&w, hbp_amp_sum(d));
    finish(d, &w);
}

static void send_fault(hbp_device *d) {
    writer w;
    d->fault_left_ms = (uint16_t)(FAULT_PERIOD_MS + (d->phase_us > 0));
    if (!d->has_session) return;
    begin(d, &w, FAULT);
    put16(&w, d->faults); put16(&w, d->fault_channel);
    put32(&w, (uint32_t)d->fault_value); put32(&w, d->fault_tick);
    finish(d, &w);
}

/* ---- Output ------------------------------------------------------------------------------ */
static int is_live(uint8_t state) { return state >= HBP_ARMED && state <= HBP_RAMP; }
static int has_output(uint8_t state) { return state >= HBP_RUN && state <= HBP_RAMP; }
static int may_sound(const hbp_device *d, unsigned ch) {
    return DEFECT(MASK_UNUSED) || (d->mask[ch / 32] >> ch % 32 & 1);
}

/* Writes what the sample interrupt reads. */
static void refresh(hbp_device *d) {
    unsigned i;
    for (i = 0; i < HBP_CHANNELS; i++) {
        uint32_t low = (uint32_t)d->slewed[2 * i] * d->gain_step / d->gain_steps;
        uint32_t high = (uint32_t)d->slewed[2 * i + 1] * d->gain_step / d->gain_steps;
        if (d->ident_on) low = 0, high = i == d->ident_channel ? d->ident_amp : 0;
        d->drive[i] = is_live(d->state) ? low | high << 16 : 0; /* one write: no torn pair */
    }
}

static void end_ident(hbp_device *d) {
    if (d->ident_on) d->ident_on = 0, refresh(d);
}

/* The one place where the state changes: high voltage is on from ARMED to RAMP. */
static void enter(hbp_device *d, uint8_t state) {
    int was_live = is_live(d->state);
    d->state = state;
    if (was_live != is_live(state)) {
        d->port.high_voltage(d->port.context, is_live(state) ? d->hv_dv : 0);
    }
}

/* From here output only falls, and no frame helps; at zero the device is in `end`. */
static void descend(hbp_device *d, uint8_t end) {
    unsigned i;
    for (i = 0; i < HBP_QUEUE; i++) d->queue[i].full = 0;
    d->descending = 1;
    d->descent_end = end;
}

/* Zero output, empty queue, full gain for the next frame, and on to `state`. */
static void silence(hbp_device *d, uint8_t state) {
    unsigned i;
    for (i = 0; i < HBP_VALUES; i++) d->target[i] = d->slewed[i] = 0, d->drive[i / 2] = 0;
    d->gain_steps = d->ramp_ms > 0 ? d->ramp_ms : 1;
    d->gain_step = d->gain_steps;
    descend(d, state);
    d->descending = d->ident_on = 0;
    enter(d, state);
    if (state == HBP_IDLE) d->has_session = 0;
    if (state == HBP_ARMED) d->has_frame = 0; /* an old age must not start a ramp */
}

uint32_t hbp_amp_sum(const hbp_device *d) {
    uint32_t sum = 0; /* at most 253 * 65535, times a gain of at most 100 steps: fits */
    unsigned i;
    if (!is_live(d->state) || d->stale) return 0;
    if (d->ident_on) return d->ident_amp;
    for (i = 0; i < HBP_VALUES; i++) sum += d->slewed[i];
    return DEFECT(SUM_BEFORE_GAIN) ? sum : sum * d->gain_step / d->gain_steps;
}

void hbp_sample(hbp_device *d, uint16_t codes[HBP_CHANNELS]) {
    unsigned i = d->sample, channel;
    int32_t sine_40 = sine(i), sine_320 = sine(8 * i % 200);
    /* Nobody looks at hold, ramp and lease any more: silence. */
    if (++d->n_sampled - d->n_sampled_at_step > STALE_SAMPLES) d->stale = 1;
    for (channel = 0; channel < HBP_CHANNELS; channel++) {
        uint32_t pair = d->stale ? 0 : d->drive[channel]; /* together <= 65535: the sum fits */
        int32_t value = (int32_t)(pair & 0xFFFF) * sine_40 + (int32_t)(pair >> 16) * sine_320;
        /* Half scale and half a step are added first: no shift of a negative number. */
        codes[channel] = (uint16_t)(((uint32_t)value + 0x80000000u + 0x80000u) >> 20);
    }
    d->sample = (uint16_t)((i + 1) % HBP_SAMPLES_PER_TICK);
}

/* ---- What the host asks: each gives an ACK code, NO_REPLY or NOT_VALID -------------------- */
static int hello(hbp_device *d, const uint8_t *p) {
    int common = (p[8] <= VERSION && VERSION <= p[9]) || DEFECT(VERSION_NOT_ASKED);
    uint8_t state = d->state == HBP_FAULT ? HBP_FAULT : common ? HBP_READY : HBP_IDLE;
    if (get32(p) != MAGIC && !DEFECT(ANY_MAGIC)) return NOT_VALID;
    if (get32(p + 4) == 0 && !DEFECT(SESSION_ZERO)) return NOT_VALID;
    if (DEFECT(HELLO_COUNTS_ANEW)) d->underrun = d->late = d->dup = d->bad = d->clipped = 0;
    d->has_frame = d->has_seq = 0;
    if (!DEFECT(HELLO_KEEPS_CONFIG)) d->configured = 0;
    if (!DEFECT(HELLO_KEEPS_STATE) || !is_live(d->state)) silence(d, state);
    d->has_session = (uint8_t)common;
    d->session = get32(p + 4);
    d->wants_status = (p[10] & 1) || DEFECT(STATUS_NOT_ASKED);
    d->lease_ms = get16(p + 12) > 0 ? get16(p + 12) : 1000;
    send_caps(d, p, common ? VERSION : 0);
    return NO_REPLY;
}

static int configure(hbp_device *d, const uint8_t *p) {
    uint16_t slew = get16(p + 6);
    unsigned i;
    writer w;
    if (d->state == HBP_FAULT) return FAULTED;
    if (d->state != HBP_READY && !DEFECT(CONFIG_ANY_TIME)) return WRONG_STATE;
    d->hold_ms = min16(get16(p + 2), DEFECT(HOLD_UNBOUNDED) ? 0xFFFF : LONGEST_SILENCE_MS);
    d->ramp_ms = d->hold_ms < LONGEST_SILENCE_MS ? LONGEST_SILENCE_MS - d->hold_ms : 0;
    d->ramp_ms = min16(get16(p + 4), DEFECT(RAMP_UNBOUNDED) ? 0xFFFF : d->ramp_ms);
    d->slew = min16(slew > 0 || DEFECT(SLEW_ZERO) ? slew : HBP_SLEW_MAX, HBP_SLEW_MAX);
    d->hv_dv = min16(get16(p + 8), DEFECT(HV_UNBOUNDED) ? 0xFFFF : HBP_HV_MAX_DV);
    d->limit[0] = min16(get16(p + 10), HBP_LIMIT_40);
    d->limit[1] = min16(get16(p + 12), HBP_LIMIT_320);
    for (i = 0; i < HBP_MASK_WORDS; i++) {
        unsigned channels = HBP_CHANNELS - 32u * i;
        uint32_t all = channels >= 32 ? 0xFFFFFFFFu : (1u << (channels & 31)) - 1;
        d->mask[i] = get32(p + 16 + 4 * i) & all;
    }
    d->configured = 1;
    begin(d, &w, CFG);
    put8(&w, 0); put8(&w, 0); put16(&w, d->hold_ms); put16(&w, d->ramp_ms); put16(&w, d->slew);
    put16(&w, d->hv_dv); put16(&w, d->limit[0]); put16(&w, d->limit[1]); put16(&w, 0);
    for (i = 0; i < HBP_MASK_WORDS; i++) put32(&w, d->mask[i]);
    finish(d, &w);
    return NO_REPLY;
}

static int arm(hbp_device *d, const uint8_t *p) {
    if (d->state == HBP_FAULT) return FAULTED;
    if (d->state == HBP_ARMED ? DEFECT(ARM_NOT_TWICE) : d->state != HBP_READY) return WRONG_STATE;
    if (!d->configured && !DEFECT(ARM_UNCONFIGURED)) return WRONG_STATE;
    if (get32(p) != d->session && !DEFECT(ARM_ANY_SESSION)) return BAD_SESSION;
    if (get32(p + 4) != (d->session ^ ARM_KEY) && !DEFECT(ARM_ANY_KEY)) return BAD_SESSION;
    if (d->state == HBP_READY) silence(d, HBP_ARMED);
    return ACK_OK;
}

/* Mask, component limit and sum guard for the two values at `out`. */
static void allow(hbp_device *d, const uint8_t *p, unsigned channel, uint16_t *out) {
    uint32_t sum;
    unsigned band;
    out[0] = out[1] = 0;
    if (!may_sound(d, channel)) return;
    for (band = 0; band < 2; band++) {
        uint16_t value = get16(p + 2 * band);
        out[band] = DEFECT(LIMIT_UNUSED) ? value : min16(value, d->limit[band]);
        if (value > d->limit[band] && !DEFECT(CLIPPED_UNCOUNTED)) d->clipped++;
    }
    sum = (uint32_t)out[0] + out[1];
    if (sum <= 65535u) return;
    d->clipped++;
    if (DEFECT(SUM_UNGUARDED)) return;
    for (band = 0; band < 2; band++) out[band] = (uint16_t)(out[band] * 65535u / sum);
}

static int frame(hbp_device *d, const uint8_t *p, uint16_t length, uint16_t seq) {
    uint32_t ahead = get32(p) == NEXT_TICK ? 1 : get32(p) - d->tick;
    int late = ahead == 0 || ahead >= 0x80000000u; /* signed: not after the present tick */
    unsigned channel, slot;
    if (length > FRAME_LENGTH) return OUT_OF_RANGE;
    if (d->state == HBP_FAULT) return FAULTED;
    if (!is_live(d->state) || (d->descending && !DEFECT(STOP_LETS_FRAMES_IN))) return WRONG_STATE;
    if (d->has_seq && d->last_seq == seq && !DEFECT(DUP_IS_TAKEN)) {
        if (DEFECT(DUP_RENEWS_AGE)) d->age_steps = 0;
        return d->dup++, NO_REPLY;
    }
    if (late) ahead = 1;
    if (late && !DEFECT(LATE_UNCOUNTED)) d->late++;
    if (late && DEFECT(LATE_IS_DROPPED)) return NO_REPLY;
    if (ahead > HBP_QUEUE && !DEFECT(QUEUE_WITHOUT_END)) return QUEUE_FULL;
    slot = (d->tick + ahead) & (HBP_QUEUE - 1);
    for (channel = 0; channel < HBP_CHANNELS; channel++) {
        if (DEFECT(FIRST_FRAME_STAYS) && d->queue[slot].full) break;
        allow(d, p + 4 + 4 * channel, channel, d->queue[slot].code + 2 * channel);
    }
    d->queue[slot].full = d->has_seq = d->has_frame = 1;
    d->last_seq = seq;
    d->age_steps = 0;
    d->age_phase_us = d->phase_us;
    if (d->state == HBP_RAMP && DEFECT(GAIN_JUMPS)) d->gain_step = d->gain_steps;
    if (d->state == HBP_ARMED || d->state == HBP_RAMP) enter(d, HBP_RUN);
    end_ident(d);
    return NO_REPLY;
}

static int stop(hbp_device *d, const uint8_t *p) {
    uint8_t end = d->descending ? d->descent_end : HBP_READY;
    int ramps = (p[1] == 0 || DEFECT(STOP_ALWAYS_RAMPS)) && !DEFECT(STOP_NEVER_RAMPS);
    if (has_output(d->state) && ramps) {
        descend(d, end);
        enter(d, HBP_RAMP);
    } else if (d->state != HBP_FAULT && (d->state != HBP_IDLE || DEFECT(STOP_OPENS))) {
        silence(d, end);
    }
    return ACK_OK;
}

static int ping(hbp_device *d, const uint8_t *p) {
    writer w;
    if (DEFECT(PING_WANTS_SESSION) && !d->has_session) return NO_REPLY;
    begin(d, &w, PONG);
    put32(&w, get32(p)); put32(&w, d->dev_us + d->phase_us); put32(&w, d->tick);
    put16(&w, DEFECT(PHASE_IS_ZERO) ? 0 : d->ms_in_tick * 1000u + d->phase_us);
    finish(d, &w);
    return NO_REPLY;
}

static int clear(hbp_device *d, const uint8_t *p) {
    if (get16(p) & d->faults & d->causes) return FAULTED;
    d->faults &= (uint16_t)~get16(p);
    if (d->state == HBP_FAULT && d->faults == 0) {
        silence(d, (uint8_t)(d->has_session ? HBP_READY : HBP_IDLE));
    }
    return ACK_OK;
}

static int ident(hbp_device *d, const uint8_t *p) {
    uint16_t channel = get16(p), ms = get16(p + 2);
    if (!HBP_IDENT) return UNKNOWN_TYPE;
    if (d->state != (DEFECT(IDENT_UNARMED) ? HBP_READY : HBP_ARMED)) return WRONG_STATE;
    if (channel >= HBP_CHANNELS || ms > LONGEST_IDENT_MS) return OUT_OF_RANGE;
    d->ident_on = 1;
    d->ident_channel = channel;
    d->ident_amp = may_sound(d, channel) ? min16(get16(p + 4), d->limit[1]) : 0;
    d->ident_left_ms = (uint16_t)(ms + (d->phase_us > 0));
    refresh(d);
    return ACK_OK;
}

static int act(hbp_device *d, uint8_t type, uint16_t seq, const uint8_t *p, uint16_t length) {
    static const uint16_t shortest[] = { 0, 16, CONFIG_LENGTH, 8, FRAME_LENGTH, 2, 4, 2, 8, 6 };
    uint16_t least = type <= IDENT ? shortest[type] : 0;
    if (type >= FIRST_OF_DEVICE && !DEFECT(UPPER_IS_ANSWERED)) return NOT_VALID;
    if (length < least) return DEFECT(SHORT_IS_ANSWERED) ? OUT_OF_RANGE : NOT_VALID;
    if (DEFECT(LONG_IS_REFUSED) && type <= IDENT && length > least) return OUT_OF_RANGE;
    switch (type) {
    case HELLO: return hello(d, p);
    case CONFIG: return configure(d, p);
    case ARM: return arm(d, p);
    case FRAME: return frame(d, p, length, seq);
    case STOP: return stop(d, p);
    case PING: return ping(d, p);
    case CLEAR: return clear(d, p);
    case IDENT: return ident(d, p);
    case SAMPLES: return DEFECT(SAMPLES_TAKEN) ? ACK_OK : UNKNOWN_TYPE; /* no mode B here */
    default: return UNKNOWN_TYPE;
    }
}

/* ---- Receiving --------------------------------------------------------------------------- */
static void store(hbp_device *d, uint8_t byte) {
    if (d->body_length < HBP_MAX_BODY) {
        d->body[d->body_length++] = byte;
    } else if (d->text == TEXT_GROWING) {
        d->text = TEXT_OVERSIZE;
        if (!DEFECT(OVERSIZE_UNCOUNTED)) d->bad++;
    }
}

/* A zero came: what lies before it is a packet, or bad, or nothing. */
static void end_of_text(hbp_device *d) {
    uint16_t covered = (uint16_t)(d->body_length - CRC);
    uint8_t text = d->text;
    int answer = NOT_VALID;
    d->text = TEXT_EMPTY;
    if (DEFECT(EMPTY_IS_BAD) && text == TEXT_EMPTY) d->bad++;
    if (text != TEXT_GROWING) return; /* empty, or oversize and counted already */
    if ((d->cobs_left == 0 || DEFECT(CUT_BLOCK_TAKEN)) && d->body_length >= HEADER + CRC
        && (crc32(d->body, covered) == get32(d->body + covered) || DEFECT(CRC_UNREAD))
        && (d->body[1] == 0 || !DEFECT(FLAGS_ARE_BAD))) {
        answer = act(d, d->body[0], get16(d->body + 2), d->body + HEADER,
                     (uint16_t)(covered - HEADER));
    }
    if (answer != NOT_VALID || DEFECT(BAD_RENEWS_LEASE)) d->quiet_ms = 0;
    if (answer == NOT_VALID) d->bad++;
    if (answer < NO_REPLY) {
        writer w;
        begin(d, &w, ACK);
        put8(&w, d->body[0]); put8(&w, (uint32_t)answer); put16(&w, get16(d->body + 2));
        finish(d, &w);
    }
}

void hbp_receive(hbp_device *d, uint16_t phase_us, uint8_t byte) {
    d->phase_us = phase_us;
    if (byte == 0) {
        end_of_text(d);
        return;
    }
    if (d->text == TEXT_EMPTY) {
        d->text = TEXT_GROWING;
        d->body_length = d->cobs_left = d->cobs_zero = 0;
    }
    if (d->cobs_left > 0) {
        d->cobs_left--;
        store(d, byte);
    } else {
        if (d->cobs_zero) store(d, 0);
        d->cobs_left = (uint8_t)(byte - 1);
        d->cobs_zero = byte < 255;
    }
}

/* ---- Time -------------------------------------------------------------------------------- */
/* The lease ran out or the cable is gone: running output ramps down first. */
static void end_session(hbp_device *d) {
    if (has_output(d->state) && !DEFECT(LEASE_CUTS)) descend(d, HBP_IDLE), enter(d, HBP_RAMP);
    else if (d->state == HBP_FAULT) d->has_session = 0;
    else silence(d, HBP_IDLE);
}

/* One ms of hold, ramp, or the way back up. */
static void step_gain(hbp_device *d) {
    int silent = d->has_frame && d->age_steps > d->hold_ms && !DEFECT(HOLD_WITHOUT_END);
    uint8_t after = DEFECT(SILENCE_STAYS_ARMED) ? HBP_ARMED : HBP_READY;
    if (DEFECT(SILENCE_AT_TICKS) && d->ms_in_tick > 0) return;
    if (silent || d->descending) {
        enter(d, HBP_RAMP);
        d->gain_step = (uint16_t)(d->ramp_ms > 0 && !DEFECT(RAMP_SKIPPED) ? d->gain_step - 1 : 0);
        if (d->gain_step == 0) silence(d, d->descending ? d->descent_end : after);
        else refresh(d);
    } else if (d->gain_step < d->gain_steps) {
        d->gain_step++;
        refresh(d);
    }
}

static uint16_t moved(uint16_t now, uint16_t target, uint16_t largest) {
    if (target > now) return (uint16_t)(target - now > largest ? now + largest : target);
    return (uint16_t)(now - target > largest ? now - largest : target);
}

/* The frame of the tick that begins takes effect. */
static void apply_frame(hbp_device *d) {
    unsigned slot = d->tick & (HBP_QUEUE - 1), i;
    int applied = d->queue[slot].full;
    if (applied && d->state == HBP_HOLD) enter(d, HBP_RUN);
    if (!applied && d->has_frame) {
        if (!DEFECT(UNDERRUN_UNCOUNTED)) d->underrun++;
        if (d->state == HBP_RUN) enter(d, HBP_HOLD);
    }
    for (i = 0; i < HBP_VALUES; i++) {
        if (applied) d->target[i] = d->queue[slot].code[i];
        /* A ramp without a new frame only falls. */
        if (applied || d->state != HBP_RAMP) {
            uint16_t slew = DEFECT(SLEW_UNUSED) ? 0xFFFF : d->slew;
            d->slewed[i] = moved(d->slewed[i], d->target[i], slew);
        }
    }
    d->queue[slot].full = 0;
    refresh(d);
}

void hbp_step_ms(hbp_device *d) {
    uint32_t n_sampled = d->n_sampled - d->n_sampled_at_step;
    d->n_sampled_at_step += n_sampled;
    /* In time again, not merely making up for lost steps: output may sound. */
    if (n_sampled >= PROMPT_SAMPLES && n_sampled <= STALE_SAMPLES) d->stale = 0;
    d->phase_us = 0;
    d->dev_us += 1000;
    d->ms_in_tick = (uint16_t)((d->ms_in_tick + 1) % HBP_MS_PER_TICK);
    if (d->ms_in_tick == 0) d->tick++;
    if (d->age_steps < 0x10000u) d->age_steps++;
    if (d->quiet_ms < 0x10000u) d->quiet_ms++;
    if (d->ident_left_ms > 0) d->ident_left_ms--;
    if (d->fault_left_ms > 0) d->fault_left_ms--;
    if (d->has_session && d->quiet_ms > d->lease_ms && !DEFECT(LEASE_WITHOUT_END)) end_session(d);
    if (d->ident_left_ms == 0 && !DEFECT(IDENT_WITHOUT_END)) end_ident(d);
    if (is_live(d->state)) step_gain(d);
    if (d->state == HBP_FAULT && d->has_session && d->fault_left_ms == 0) send_fault(d);
    if (d->ms_in_tick > 0) return;
    if (is_live(d->state) && !d->descending) apply_frame(d);
    if (d->has_session && d->wants_status) send_status(d);
}

/* ---- The rest of the interface ----------------------------------------------------------- */
void hbp_raise_fault(hbp_device *d, uint16_t phase_us, uint16_t bits, uint16_t channel,
                     int32_t value) {
    d->phase_us = phase_us;
    d->faults |= bits;
    d->causes |= bits;
    d->fault_channel = channel;
    d->fault_value = value;
    d->fault_tick = d->tick;
    silence(d, HBP_FAULT);
    send_fault(d);
}

void hbp_end_fault_cause(hbp_device *d, uint16_t bits) { d->causes &= (uint16_t)~bits; }
void hbp_link_lost(hbp_device *d) { if (d->has_session) end_session(d); }

void hbp_init(hbp_device *d, const hbp_port *port) {
    uint8_t *bytes = (uint8_t *)d;
    uint32_t i;
    for (i = 0; i < sizeof *d; i++) bytes[i] = 0;
    d->port = *port;
    d->gain_step = d->gain_steps = 1;
    d->port.high_voltage(d->port.context, 0);
}
