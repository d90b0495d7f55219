/* hbp_core.h - a device of the protocol HBP v1 (see ../protocol.md).
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * Portable C99: no heap, no libc, no clock, no I/O. A port supplies three functions (hbp_port) and
 * calls five: hbp_init once, hbp_step_ms every millisecond, hbp_receive for every received byte,
 * hbp_sample 8000 times a second, hbp_raise_fault when something breaks. README.md tells how.
 *
 * All but hbp_sample must not interrupt each other: call them from one loop, or from interrupts of
 * one priority. hbp_sample may interrupt them: it reads `drive`, one 32-bit word a channel, and
 * falls silent by itself when hbp_step_ms has not run for 20 ms, until that runs in time again.
 */
#ifndef HBP_CORE_H
#define HBP_CORE_H

#include <stdint.h>
#include "hbp_config.h" /* what this array is, and the maxima that no CONFIG gets beyond */

#define HBP_CHANNELS (HBP_ROWS * HBP_COLS)
#define HBP_MASK_WORDS ((HBP_CHANNELS + 31) / 32)
#define HBP_VALUES (2 * HBP_CHANNELS) /* per channel A40, A320 */
#define HBP_MS_PER_TICK 25
#define HBP_SAMPLES_PER_TICK 200 /* 8 kHz */

#if HBP_CHANNELS < 1 || HBP_CHANNELS > 253 || HBP_QUEUE < 1 || HBP_QUEUE > 128 \
    || (HBP_QUEUE & (HBP_QUEUE - 1)) != 0 || HBP_MAX_BODY < 64 || HBP_MAX_BODY > 1024 \
    || HBP_MAX_BODY < 12 + 4 * HBP_CHANNELS
#error "hbp_config.h: a value is out of its range, or HBP_MAX_BODY too small for a FRAME"
#endif

/* States, as in STATUS. */
enum { HBP_IDLE, HBP_READY, HBP_ARMED, HBP_RUN, HBP_HOLD, HBP_RAMP, HBP_FAULT };

/* Fault bits. HBP_LEASE_LOST is informative: the core shows it, nobody raises it. */
enum {
    HBP_OVER_TEMPERATURE = 1, HBP_OVER_CURRENT = 2, HBP_HIGH_VOLTAGE = 4, HBP_CONVERTER = 8,
    HBP_WATCHDOG = 16, HBP_LEASE_LOST = 32, HBP_EMERGENCY_STOP = 64, HBP_SELF_TEST = 128
};

/* What a board can measure; leave 0 what it cannot. Units: 0.1 V, mA, 0.01 C. */
typedef struct { uint16_t hv_dv, i_ma; int16_t temp_cdeg; } hbp_measured;

/* What the core needs of a board; `context` is handed to each function. `send` sends one whole
 * packet or none of it and never waits. `high_voltage` sets 0.1 V, 0 = off; it is called whenever
 * that goes on or off. `measure` fills in what STATUS tells, at every tick of a session. */
typedef struct {
    void *context;
    void (*send)(void *context, const uint8_t *bytes, uint16_t length);
    void (*high_voltage)(void *context, uint16_t dv);
    void (*measure)(void *context, hbp_measured *measured);
    const uint8_t *uid; /* the chip's own number, 12 bytes that last; 0: HBP_UID */
} hbp_port;

/* One device. Read it freely, write nothing. */
typedef struct {
    hbp_port port;
    /* Clock: tick and dev_us count from boot and wrap. */
    uint32_t tick, dev_us;
    uint16_t phase_us, ms_in_tick;
    /* Session. */
    uint8_t state, descending, descent_end, has_session, wants_status, configured;
    uint8_t has_seq, has_frame; /* an accepted FRAME since HELLO, and since ARM */
    uint16_t last_seq, next_seq, lease_ms;
    uint32_t session, quiet_ms; /* quiet_ms: since the last valid packet */
    /* Settings in force, and which channels may sound. */
    uint16_t hold_ms, ramp_ms, slew, hv_dv, limit[2];
    uint32_t mask[HBP_MASK_WORDS];
    uint16_t underrun, late, dup, bad, clipped; /* counters since boot: they wrap */
    /* Age of the last accepted FRAME: steps of the 1 ms clock since, its phase within one. */
    uint32_t age_steps;
    uint16_t age_phase_us;
    /* Faults. */
    uint16_t faults, causes, fault_channel, fault_left_ms;
    int32_t fault_value;
    uint32_t fault_tick;
    /* Output: newest target, after slew, after gain. The gain is gain_step / gain_steps. */
    uint16_t target[HBP_VALUES], slewed[HBP_VALUES];
    volatile uint32_t drive[HBP_CHANNELS]; /* A40 | A320 << 16 */
    uint16_t gain_step, gain_steps;
    uint8_t ident_on;
    uint16_t ident_channel, ident_amp, ident_left_ms;
    struct { uint8_t full; uint16_t code[HBP_VALUES]; } queue[HBP_QUEUE];
    volatile uint16_t sample;
    volatile uint32_t n_sampled; /* since boot */
    uint32_t n_sampled_at_step;
    volatile uint8_t stale; /* hbp_sample found hbp_step_ms not running */
    /* Receiver. */
    uint8_t body[HBP_MAX_BODY];
    uint16_t body_length;
    uint8_t text, cobs_left, cobs_zero;
} hbp_device;

/* Boots a device: IDLE, high voltage off, all counters 0. */
void hbp_init(hbp_device *device, const hbp_port *port);
/* One step of the 1 ms safety clock; every 25th begins a tick. */
void hbp_step_ms(hbp_device *device);
/* Takes one byte that came phase_us (0 to 999) after the last hbp_step_ms. */
void hbp_receive(hbp_device *device, uint16_t phase_us, uint8_t byte);
/* Something broke: output zero and high voltage off at once, latched until CLEAR. `channel` is
 * 65535 when no channel is meant; `value` is in the fault's own unit. */
void hbp_raise_fault(hbp_device *device, uint16_t phase_us, uint16_t bits, uint16_t channel,
                     int32_t value);
/* The cause of these fault bits is gone; CLEAR is accepted from now on. */
void hbp_end_fault_cause(hbp_device *device, uint16_t bits);
/* DTR dropped, USB suspended or reset: as if the lease had run out. Call within 20 ms. */
void hbp_link_lost(hbp_device *device);
/* The next sample of all channels: 12-bit codes around 2048. Exactly 8 calls a millisecond. */
void hbp_sample(hbp_device *device, uint16_t codes[HBP_CHANNELS]);
/* Sum of all output codes after gain, as in STATUS. */
uint32_t hbp_amp_sum(const hbp_device *device);

#endif
