//! Lies about rules: what the device does, or leaves, against sections 2.1 to 2.8 of the protocol.
//! The device asks for a rule where it keeps it.

use super::declared::{Act, Declared, Takes};

/// Declares rules: variant, name, the largest value and the values to try it with where it takes
/// one, section, and what the device does.
macro_rules! rules {
    ($($rule:ident $name:literal $(($most:literal: $($example:literal),+))? $help:literal;)+) => {
        /// A rule that a lie breaks.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum Rule {
            $($rule,)+
        }

        /// All of them, section by section.
        pub(super) const RULES: &[Declared] = &[
            $(Declared {
                name: $name,
                takes: rules!(@takes $($most)?),
                examples: &[$($($example),+)?],
                help: $help,
                act: Act::Rule(Rule::$rule),
            },)+
        ];
    };
    (@takes) => { Takes::Nothing };
    (@takes $most:literal) => { Takes::UpTo($most) };
}

#[rustfmt::skip]
rules! {
    NoCrcCheck "no-crc-check" "2.1: takes packets with a wrong CRC";
    LoneZeroBad "lone-zero-bad" "2.1: counts an empty text between two zeros as bad";
    LoneOneIgnored "lone-one-ignored" "2.8: does not count a lone 01 as bad";
    FlagsRefused "flags-refused" "2.1: refuses packets whose header has a flag";
    FullBlockRefused "full-block-refused" "2.8: refuses the 01 behind a final block of 254 bytes";
    LosesNext "loses-next-after-bad" "2.1: loses the packet behind a text that is none";
    OversizeAccepted "oversize-accepted" "2.1: takes bodies that are larger than its CAPS allow";
    ShorterBody "shorter-body" (200: "1", "40")
        "2.1: takes bodies only so many bytes smaller than its CAPS allow";
    BadTwice "bad-counted-twice" "2.8: counts each text that is no packet twice";
    Echo "echo" "2.8: sends back what it gets, as a terminal does";
    SeqStuck "seq-stuck" "2.1: sends the same seq in every packet";
    FlagsSent "flags-sent" (255: "1", "255") "2.1: sends packets with these flags in their header";
    NoLeadingZero "no-leading-zero" "2.1: sends packets without the zero before them";
    BadCrcEvery "bad-crc-every" (1000: "1", "3") "2.1: every so many packets one with a wrong CRC";
    RepeatsPackets "repeats-packets" "2.1: sends every packet twice";
    Banner "banner" "2.1: sends a text before CAPS";
    LogFlood "log-flood" "2.2: sends a LOG every ms, wanted or not";
    LogOdd "log-odd" "2.2: sends LOG with control characters and bytes that are no UTF-8";
    LogUnasked "log-unasked" "2.2: sends LOG without host flag b1";

    AnyMagic "hello-any-magic" "2.8: takes HELLO with another magic";
    SessionZero "hello-session-zero" "2.8: takes HELLO with session 0";
    VersionAny "version-any" "2.6: chooses version 1 though none is common";
    VersionKeepsSession "version-keeps-session"
        "2.8: keeps the session though no version is common";
    HelloIgnoredLive "hello-ignored-live" "2.6: does not answer HELLO while armed";
    HelloKeepsOutput "hello-keeps-output" "2.8: goes on with its output through HELLO";
    HelloKeepsConfig "hello-keeps-config" "2.8: needs no CONFIG in a new session";
    HelloKeepsQueue "hello-keeps-queue" "2.6: keeps waiting frames through HELLO";
    HelloKeepsSeq "dup-seq-kept-over-hello"
        "2.8: keeps last_seq, and so the duplicate, through HELLO";
    HelloResetsCounters "hello-resets-counters" "2.8: begins its counters anew at HELLO";
    HelloResetsClock "hello-resets-clock" "2.8: begins its ticks anew at HELLO";
    HelloClearsFault "hello-clears-fault" "2.8: clears faults at HELLO";
    FaultBlocksHello "fault-blocks-hello" "2.8: does not answer HELLO while a fault is latched";
    ArmedByHello "armed-by-hello" "2.7: is armed by HELLO alone";
    LeaseFixed "lease-fixed" "2.2: keeps a lease of 1000 ms whatever HELLO asks";
    LeaseZero "lease-zero-is-zero" "2.2: takes a lease of 0 as none, not as 1000 ms";

    StatusUnasked "status-unasked" "2.2: sends STATUS without host flag b0";
    NoStatus "no-status" "2.5: sends no STATUS";
    StatusEvery "status-every" (100: "2", "3") "2.5: sends STATUS only every so many ticks";
    StatusFlood "status-flood" (20: "1", "10") "2.5: sends every STATUS so many times more";
    StatusOld "status-old" (60: "1", "20") "2.5: sends after each STATUS that of so many ticks ago";
    StatusLate "status-late" (24: "5", "20") "2.5: sends STATUS so many ms after its tick began";
    TickJumps "tick-jumps" (1_000_000: "3", "41")
        "2.8: tells ticks that jump by so many every 40 ticks";
    StatusBeforeFrame "status-before-frame"
        "2.8: tells in STATUS what was before the frame of the tick";
    SumBeforeGain "amp-sum-before-gain" "2.2: tells the sum without the gain of hold and ramp";
    SumOfTarget "amp-sum-of-target" "2.8: tells the sum where slew is to lead, not where it is";
    AgeZero "age-zero-without-frame" "2.2: tells an age of 0 ms before the first frame";

    NoPong "no-pong" "2.8: does not answer PING";
    PingSilentIdle "ping-silent-when-idle" "2.8: does not answer PING without a session";
    FrameAcked "frame-acked" "2.2: acknowledges accepted frames";
    FrameRefusalSilent "frame-refusal-silent" "2.2: refuses frames without ACK";
    ConfigRefusalSilent "config-refusal-silent" "2.2: refuses CONFIG without ACK";
    ArmWithoutAck "arm-without-ack" "2.2: does not acknowledge ARM";
    StopWithoutAck "stop-without-ack" "2.8: does not acknowledge STOP";
    ClearWithoutAck "clear-without-ack" "2.2: does not acknowledge CLEAR";
    IdentWithoutAck "ident-without-ack" "2.2: does not acknowledge IDENT";
    UnknownSilent "unknown-type-silent" "2.6: does not answer an unknown type";
    UnknownBad "unknown-type-bad" "2.8: counts an unknown type as bad";
    UnknownFaults "unknown-type-faults" "2.6: an unknown type is a fault";
    SamplesAccepted "samples-accepted" "2.8: acknowledges SAMPLES with code 0 without mode B";
    AnswersDeviceTypes "answers-device-types" "2.8: answers types from 80 on";
    ShortAccepted "short-payload-accepted" "2.6: takes zeros for what a payload lacks";
    ShortAnswered "short-payload-answered" "2.8: answers a payload that is too short with code 5";
    ShortRenewsLease "short-payload-renews-lease"
        "2.8: a payload that is too short renews the lease";
    TrailingRefused "trailing-bytes-refused"
        "2.6: counts payloads with more bytes than it knows as bad";
    LongFrameAccepted "long-frame-accepted" "2.8: takes FRAME with bytes too many";
    LongFrameBad "long-frame-bad" "2.8: counts FRAME with bytes too many as bad, without ACK";

    ConfigLive "config-while-armed" "2.2: takes CONFIG while armed or running";
    ConfigIdle "config-in-idle" "2.2: takes CONFIG without a session";
    ConfigFault "config-in-fault" "2.8: takes CONFIG while a fault is latched";
    ConfigRefused "config-refused" "2.2: refuses CONFIG in READY too";
    RefusedConfigHolds "refused-config-holds" "2.8: refuses CONFIG outside READY but keeps to it";
    ConfigIgnored "config-ignored" "2.2: answers a second CONFIG but keeps to the first";
    HoldUnclamped "hold-unclamped" "2.8: grants a hold above 100 ms";
    RampUnclamped "ramp-unclamped" "2.8: grants a ramp beyond 100 ms with the hold";
    HvUnclamped "hv-unclamped" "2.7: grants a high voltage above its largest";
    LimitUnclamped "limit-unclamped" "2.7: grants codes above its largest";
    SlewUnclamped "slew-unclamped" "2.7: grants steps above its largest";
    SlewZeroKept "slew-zero-kept" "2.8: takes a slew of 0 as 0";
    ModeKept "mode-kept" "2.8: grants a mode that it has not";
    FlagsKept "flags-kept" "2.8: grants flags that it has not";
    MaskKept "mask-kept" "2.8: grants mask bits of channels that it has not";
    MaskZeroIsAll "mask-zero-is-all" "2.8: takes a mask of 0 as all on";
    NoMask "no-mask" "2.8: drives masked channels";
    MaskShifted "mask-shifted" "2.2: takes mask bits for the channel after them";
    NoCompLimit "no-comp-limit" "2.2: does not clamp to comp_limit";
    LimitZeroIsNone "limit-zero-is-none" "2.8: takes a comp_limit of 0 as none";
    LimitsSwapped "limits-swapped" "2.2: keeps to each limit in the other component";
    NoSlew "no-slew" "2.8: does not keep to slew";
    SlewHalf "slew-half" "2.8: moves by half of slew";
    HvHigher "hv-higher" (60000: "10", "500") "2.7: makes so many 0.1 V more than granted";

    AnySession "arm-any-session" "2.8: takes ARM with another session";
    AnyKey "arm-any-key" "2.8: takes ARM with another key";
    ArmWithoutConfig "arm-without-config" "2.8: takes ARM without CONFIG in the session";
    ArmRepeatRefused "arm-repeat-refused" "2.8: refuses ARM in ARMED";
    ArmWhileRunning "arm-while-running" "2.8: takes ARM in RUN, HOLD and RAMP";
    ArmIdle "arm-in-idle" "2.8: takes ARM without a session";
    ArmFault "arm-in-fault" "2.8: takes ARM while a fault is latched";
    ArmIgnored "arm-ignored" "2.2: acknowledges ARM and stays in READY";
    ArmedAtStart "armed-at-start" "2.7: boots armed, with high voltage";
    ArmedByConfig "armed-by-config" "2.7: is armed by CONFIG alone";
    ArmedTimesOut "armed-times-out" (10000: "100", "500")
        "2.8: goes from ARMED to READY after so many ms without a frame";
    FrameWithoutArm "frame-without-arm" "2.7: plays frames in READY";
    RearmsItself "rearms-itself" "2.7: is armed again after its silence";
    NoHv "no-hv" "2.8: makes no high voltage";
    NoHvOff "no-hv-off" "2.8: keeps high voltage on after READY";
    HvInReady "hv-in-ready" "2.8: makes high voltage from READY on";

    BandsSwapped "bands-swapped" "2.2: takes A40 for A320 in FRAME";
    ChannelsReversed "channels-reversed"
        "2.2: takes the channels of FRAME from the last to the first";
    BigEndian "frame-big-endian" "2.1: reads the codes of FRAME big-endian";
    NextRefused "next-refused" "2.8: does not know tick FFFFFFFF";
    LateDropped "late-dropped" "2.5: counts late frames and forgets them";
    LateRefused "late-refused" "2.5: refuses late frames with code 3";
    FramesEarly "frames-early" "2.5: plays frames for later ticks at the next one";
    FramesDelayed "frames-delayed" "2.5: plays frames a tick after theirs";
    QueueOrder "queue-order" "2.5: plays frames in the order in which they came";
    FirstWriterWins "first-writer-wins" "2.5: keeps the first frame of a tick";
    QueueShallow "queue-shallow" (255: "1", "3")
        "2.8: takes so many frames fewer ahead than CAPS say";
    QueueDeep "queue-deep" (200: "1", "100")
        "2.8: takes frames so many ticks further ahead than CAPS say";
    LastSeqRefused "last-seq-counts-refused" "2.8: tells a refused frame as the last accepted";
    LastSeqNotLate "last-seq-not-late" "2.8: does not tell a late frame as the last accepted";
    DupApplied "dup-applied" "2.6: plays a frame with the seq of the last accepted one";
    DupRenewsAge "dup-renews-age" "2.8: a repeated frame renews the age";
    DupNotLease "dup-not-lease" "2.8: a repeated frame does not renew the lease";
    DupRefused "dup-refused" "2.6: refuses a repeated frame with code 2";
    DupAnyType "dup-any-type" "2.8: ignores every packet with the seq of the last accepted frame";
    UnderrunFromArm "underrun-from-arm" "2.8: counts ticks before the first frame as underrun";
    NoHoldState "no-hold-state" "2.8: stays in RUN through a tick without a frame";
    HoldStays "hold-stays" "2.8: stays in HOLD when frames come again";
    HoldMutes "hold-mutes" "2.6: is silent in a tick without a frame";
    SlewOnlyFrames "slew-only-on-frames" "2.8: does not slew in HOLD";
    InterpolatesUnasked "interpolates-unasked" "2.4: moves linearly inside a tick, unasked";
    NoSumGuard "no-sum-guard" "2.4: puts out A40 + A320 above full drive";
    SumGuardUncounted "sum-guard-uncounted"
        "2.8: scales channels above full drive without counting them";
    SumGuardCuts "sum-guard-cuts" "2.4: lowers A320 alone where the sum is above full drive";
    ClippedOnce "clipped-once-a-frame" "2.8: counts one clipped value a frame";
    ClippedAtTick "clipped-at-tick"
        "2.8: counts clipped values when their frame is played, not when it comes";
    MaskClips "mask-clips" "2.8: counts values of masked channels as clipped";

    NoRamp "no-ramp" "2.7: never ramps when the host falls silent";
    HoldLonger "hold-longer" (60000: "1", "40", "1000") "2.8: holds so many ms longer than it says";
    HoldShorter "hold-shorter" (100: "1", "20") "2.8: holds so many ms less than it says";
    RampLonger "ramp-longer" (60000: "1", "40", "1000") "2.8: ramps so many ms longer than it says";
    RampShorter "ramp-shorter" (100: "1", "20") "2.8: ramps so many ms less than it says";
    RampZeroNever "ramp-zero-never" "2.8: takes a ramp of 0 ms as no ramp at all";
    TickClock "silence-at-ticks" "2.7: holds and ramps by ticks instead of ms";
    AgeFromApply "age-from-apply"
        "2.8: counts the age from the tick of a frame, not from when it came";
    GainJumps "gain-jumps" "2.7: jumps to full gain at a frame in RAMP";
    GainStays "gain-stays" "2.8: keeps the gain that it had at a frame in RAMP";
    RampRefusesFrames "ramp-refuses-frames" "2.8: refuses frames in a RAMP of silence";
    RampEndsIdle "ramp-ends-idle" "2.7: goes from RAMP to IDLE instead of READY";
    IgnoreStop "ignore-stop" "2.8: acknowledges STOP and goes on";
    StopRefused "stop-refused" "2.8: refuses STOP with code 2 and goes on";
    StopIdleRefused "stop-in-idle-refused" "2.2: refuses STOP without a session";
    StopKeepsQueue "stop-keeps-queue" "2.8: keeps waiting frames through STOP and ARM";
    StopKeepsArmed "stop-keeps-armed" "2.8: is still armed after STOP";
    StopNowRamps "stop-now-ramps" "2.2: ramps at STOP with how 1";
    StopRampAtOnce "stop-ramp-at-once" "2.8: is silent at once at STOP with how 0";
    StopRampRestarts "stop-ramp-restarts" "2.8: ramps from full gain at STOP";
    StopTurnedBack "stop-turned-back" "2.8: takes frames in the ramp of STOP";
    StopWakesIdle "stop-wakes-idle" "2.8: goes from IDLE to READY at STOP";
    StopLeavesFault "stop-leaves-fault" "2.8: goes from FAULT to READY at STOP";
    StopEndsSession "stop-ends-session" "2.8: goes to IDLE at STOP";
    HangUpIgnored "hang-up-ignored" "2.7: does not ramp when the cable is pulled";

    NoLease "no-lease" "2.6: never ends a session of a host that is silent";
    LeaseLonger "lease-longer" (60000: "50", "1000")
        "2.6: ends a session so many ms after its lease";
    LeaseShorter "lease-shorter" (60000: "50", "400")
        "2.6: ends a session so many ms before its lease";
    LeaseNoRamp "lease-no-ramp" "2.8: is silent at once when the lease ends";
    LeaseKeepsStatus "lease-keeps-status" "2.6: goes on with STATUS when the lease ends";
    LeaseEndsReady "lease-ends-ready" "2.6: goes to READY when the lease ends";
    LeaseFaults "lease-faults" "2.8: goes to FAULT when the lease ends";
    PingNoRenewal "ping-no-renewal" "2.8: PING does not renew the lease";
    BadRenewsLease "bad-renews-lease" "2.8: what is no packet renews the lease";

    FaultAt "fault-at" (100_000_000: "8", "120")
        "2.2: is over its temperature at this tick since boot, for 2 s";
    FaultFlood "fault-flood" "2.2: sends FAULT every ms, without a fault";
    FaultToldOnce "fault-told-once" "2.2: sends FAULT only once";
    FaultOutsideSession "fault-outside-session" "2.8: sends FAULT without a session";
    FaultKeepsOutput "fault-keeps-output" "2.8: goes on with its output through a fault";
    FaultUnlatched "fault-unlatched" "2.7: forgets a fault as soon as its cause is gone";
    ClearClearsCause "clear-clears-cause" "2.2: clears a fault whose cause persists";
    ClearAny "clear-any" "2.2: clears all faults whatever CLEAR names";
    ClearStays "clear-stays" "2.8: stays in FAULT when all faults are cleared";
    ClearEndsSession "clear-ends-session"
        "2.8: goes to IDLE when all faults are cleared in a session";
    ClearRefused "clear-refused" "2.2: refuses CLEAR of a fault whose cause is gone";

    IdentAnywhere "ident-anywhere" "2.8: drives a contactor in every state of a session";
    IdentTooLong "ident-too-long" "2.8: takes IDENT above 1000 ms";
    IdentBadChannel "ident-bad-channel" "2.8: takes IDENT of a channel that it has not";
    IdentLow "ident-low-band" "2.8: drives A40 at IDENT";
    IdentOverLimit "ident-over-limit" "2.8: drives more than comp_limit at IDENT";
    IdentLonger "ident-longer" (60000: "5", "1000") "2.8: drives so many ms longer than IDENT says";
    IdentOutlastsFrame "ident-outlasts-frame" "2.8: goes on with IDENT when a frame comes";
    IdentUnknown "ident-unknown" "2.8: does not know IDENT";
}
