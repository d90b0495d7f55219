/* hbp_defects.h - what -DHBP_DEFECT=n breaks: one rule of the protocol each, for tests only.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * A check of devices is worth what it finds. Each of these builds is a device that looks like a
 * good one and breaks a single rule; `selvedge bridge certify` finds every one. Without HBP_DEFECT,
 * or with 0, DEFECT(...) is the constant 0 and leaves nothing in the program. Never put another
 * build on a board.
 */
#ifndef HBP_DEFECTS_H
#define HBP_DEFECTS_H

#ifndef HBP_DEFECT
#define HBP_DEFECT 0
#endif

#define DEFECT(name) (HBP_DEFECT == (name))

enum {
    /* Packets */
    CRC_UNREAD = 1,          /* a packet with a wrong CRC is taken */
    CUT_BLOCK_TAKEN = 2,     /* a text that ends within a COBS block is taken */
    EMPTY_IS_BAD = 3,        /* two zeros in a row count as bad */
    OVERSIZE_UNCOUNTED = 4,  /* a text beyond max_body does not count as bad */
    SHORT_IS_ANSWERED = 5,   /* a payload shorter than its table gets ACK 5 */
    LONG_IS_REFUSED = 6,     /* a payload longer than its table gets ACK 5 */
    UPPER_IS_ANSWERED = 7,   /* a type from 80 on gets ACK 4 */
    FLAGS_ARE_BAD = 8,       /* a packet with flags counts as bad */
    /* Sessions */
    ANY_MAGIC = 9,           /* HELLO with another magic begins a session */
    SESSION_ZERO = 10,       /* HELLO with session 0 begins a session */
    HELLO_KEEPS_STATE = 11,  /* HELLO silences nothing and disarms nothing */
    HELLO_KEEPS_CONFIG = 12, /* ARM after a new HELLO needs no CONFIG */
    HELLO_COUNTS_ANEW = 13,  /* HELLO sets the counters to 0 */
    VERSION_NOT_ASKED = 14,  /* version 1 for a host that does not speak it */
    STATUS_NOT_ASKED = 15,   /* STATUS for a host that does not want it */
    LEASE_WITHOUT_END = 16,  /* no session ever ends by itself */
    BAD_RENEWS_LEASE = 17,   /* a text that is no packet renews the lease */
    LEASE_CUTS = 18,         /* at the end of the lease running output stops without a ramp */
    /* CONFIG */
    HOLD_UNBOUNDED = 19,     /* hold_ms above 100 holds */
    RAMP_UNBOUNDED = 20,     /* hold_ms + ramp_ms above 100 holds */
    SLEW_ZERO = 21,          /* slew 0 does not mean slew_max but 0 */
    HV_UNBOUNDED = 22,       /* hv_dV above hv_max_dV holds */
    CONFIG_ANY_TIME = 23,    /* CONFIG is taken while armed */
    MASK_UNUSED = 24,        /* masked channels sound */
    LIMIT_UNUSED = 25,       /* values above their limit are counted and played */
    /* ARM */
    ARM_UNCONFIGURED = 26,   /* ARM without CONFIG arms */
    ARM_ANY_KEY = 27,        /* ARM with a wrong key arms */
    ARM_ANY_SESSION = 28,    /* ARM with a session that is not this one arms */
    ARM_NOT_TWICE = 29,      /* ARM in ARMED gets ACK 2 */
    /* FRAME */
    LATE_IS_DROPPED = 30,    /* a late FRAME is counted and not played */
    LATE_UNCOUNTED = 31,     /* a late FRAME is played and not counted */
    QUEUE_WITHOUT_END = 32,  /* a FRAME for any later tick is accepted */
    DUP_IS_TAKEN = 33,       /* a repeated FRAME is accepted once more */
    DUP_RENEWS_AGE = 34,     /* a repeated FRAME is counted, and delays the silence */
    FIRST_FRAME_STAYS = 35,  /* a later FRAME for a tick does not replace the earlier one */
    SUM_UNGUARDED = 36,      /* A40 + A320 above 65535 is counted and not scaled */
    CLIPPED_UNCOUNTED = 37,  /* values above their limit are not counted */
    SLEW_UNUSED = 38,        /* codes jump to their target */
    UNDERRUN_UNCOUNTED = 39, /* a tick without a frame is not counted */
    /* Silence */
    HOLD_WITHOUT_END = 40,   /* the last frame is held for ever */
    SILENCE_AT_TICKS = 41,   /* hold and ramp are looked at once a tick, in steps of a tick */
    RAMP_SKIPPED = 42,       /* zero at the end of hold, without a ramp */
    GAIN_JUMPS = 43,         /* a FRAME in a ramp gives full output at once */
    SILENCE_STAYS_ARMED = 44, /* after the ramp: ARMED, high voltage on */
    /* STOP */
    STOP_LETS_FRAMES_IN = 45, /* FRAMEs are accepted in the ramp of a STOP */
    STOP_ALWAYS_RAMPS = 46,  /* how 1 ramps too */
    STOP_NEVER_RAMPS = 47,   /* how 0 cuts too */
    STOP_OPENS = 48,         /* STOP in IDLE leads to READY */
    /* The rest */
    PING_WANTS_SESSION = 49, /* PING is not answered in IDLE */
    PHASE_IS_ZERO = 50,      /* PONG says phase 0 whenever it is */
    SAMPLES_TAKEN = 51,      /* SAMPLES gets ACK 0 */
    IDENT_UNARMED = 52,      /* IDENT is done in READY instead of ARMED */
    IDENT_WITHOUT_END = 53,  /* IDENT goes on after its time */
    SUM_BEFORE_GAIN = 54     /* amp_sum leaves the gain out */
};

#endif
