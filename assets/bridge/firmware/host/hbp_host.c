/* hbp_host.c - the core on a desktop: runs the golden sessions, or obeys line by line.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 *   hbp_host vectors.txt    runs every session of the file; exit code 1 if one goes wrong
 *   hbp_host                obeys standard input; every line is answered by one line
 *
 * Lines: boot | at US | wait US | in HEX... | fault BITS CHANNEL VALUE | cured BITS | lost | codes
 *        | samples N
 * An answer is STATE AMP_SUM BYTES, the bytes in hex or "-"; of codes and samples, the numbers.
 * `wait` is `at` that ends early, after the first millisecond in which the device sent something;
 * its answer begins with the time.
 * Only `samples` calls hbp_sample, and it makes no step: time passes by `at`.
 * Sessions add what must hold: out HEX... | state NAME AMP_SUM | drive CHANNEL A40 A320.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../hbp_core.h"

static hbp_device device;
static unsigned long long now_ms;
static unsigned phase_us;
static uint16_t volts_dv;
static uint8_t sent[1 << 20];
static size_t n_sent;

static const char *const states[] = { "IDLE", "READY", "ARMED", "RUN", "HOLD", "RAMP", "FAULT" };

static void take(void *context, const uint8_t *bytes, uint16_t length)
{
    (void)context;
    if (n_sent + length > sizeof sent) {
        fputs("hbp_host: too many bytes between two lines\n", stderr);
        exit(2);
    }
    memcpy(sent + n_sent, bytes, length);
    n_sent += length;
}

static void high_voltage(void *context, uint16_t dv)
{
    (void)context;
    volts_dv = dv;
}

/* A board that works: the voltage asked for, no current, room temperature. */
static void measure(void *context, hbp_measured *measured)
{
    (void)context;
    measured->hv_dv = volts_dv;
    measured->temp_cdeg = 2500;
}

static void boot(void)
{
    static const hbp_port port = { 0, take, high_voltage, measure, 0 };
    now_ms = 0;
    phase_us = 0;
    n_sent = 0;
    hbp_init(&device, &port);
}

static void advance(unsigned long long us)
{
    while (now_ms < us / 1000) {
        now_ms++;
        phase_us = 0;
        hbp_step_ms(&device);
    }
    if (now_ms == us / 1000 && us % 1000 > phase_us) phase_us = (unsigned)(us % 1000);
}

static unsigned long long wait_until(unsigned long long us)
{
    while (n_sent == 0 && now_ms < us / 1000) advance((now_ms + 1) * 1000);
    if (n_sent == 0) advance(us);
    return now_ms * 1000 + phase_us;
}

static unsigned low(uint32_t pair) { return pair & 0xFFFF; }
static unsigned high(uint32_t pair) { return pair >> 16; }

/* Hex digits in pairs, blanks between them or not, to `bytes`; the number of bytes. */
static size_t read_hex(const char *text, uint8_t *bytes, size_t room)
{
    size_t n = 0;
    unsigned value;
    int used;
    while (n < room && sscanf(text, " %2x%n", &value, &used) == 1) {
        bytes[n++] = (uint8_t)value;
        text += used;
    }
    return n;
}

/* Does what any line asks; 0 for a line that is no command. */
static int obey(const char *line)
{
    static uint8_t bytes[1 << 18];
    unsigned long long us;
    unsigned bits, channel;
    long value;
    if (strncmp(line, "boot", 4) == 0) {
        boot();
    } else if (sscanf(line, "at %llu", &us) == 1) {
        advance(us);
    } else if (strncmp(line, "in ", 3) == 0) {
        size_t n = read_hex(line + 3, bytes, sizeof bytes), i;
        for (i = 0; i < n; i++) hbp_receive(&device, (uint16_t)phase_us, bytes[i]);
    } else if (sscanf(line, "fault %u %u %ld", &bits, &channel, &value) == 3) {
        hbp_raise_fault(&device, (uint16_t)phase_us, (uint16_t)bits, (uint16_t)channel,
                        (int32_t)value);
    } else if (sscanf(line, "cured %u", &bits) == 1) {
        hbp_end_fault_cause(&device, (uint16_t)bits);
    } else if (strncmp(line, "lost", 4) == 0) {
        hbp_link_lost(&device);
    } else {
        return 0;
    }
    return 1;
}

static void answer(void)
{
    size_t i;
    printf("%s %lu ", states[device.state], (unsigned long)hbp_amp_sum(&device));
    for (i = 0; i < n_sent; i++) printf("%02x", sent[i]);
    puts(n_sent > 0 ? "" : "-");
    n_sent = 0;
}

static void print_samples(unsigned n)
{
    uint16_t codes[HBP_CHANNELS];
    unsigned i;
    while (n-- > 0) {
        hbp_sample(&device, codes);
        for (i = 0; i < HBP_CHANNELS; i++) printf("%u ", codes[i]);
    }
    puts("");
}

static int obey_input(void)
{
    static char line[1 << 19];
    unsigned long long us;
    unsigned n, i;
    boot();
    while (fgets(line, sizeof line, stdin)) {
        if (strncmp(line, "codes", 5) == 0) {
            for (i = 0; i < HBP_CHANNELS; i++) {
                printf("%u %u ", low(device.drive[i]), high(device.drive[i]));
            }
            puts("");
        } else if (sscanf(line, "samples %u", &n) == 1) {
            print_samples(n);
        } else if (sscanf(line, "wait %llu", &us) == 1) {
            printf("%llu ", wait_until(us));
            answer();
        } else if (obey(line)) {
            answer();
        } else {
            puts("?");
        }
        fflush(stdout);
    }
    return 0;
}

/* One line that says what must hold; 0 when it does not, -1 when it is no such line. */
static int holds(const char *line)
{
    static uint8_t wanted[1 << 18];
    char name[16];
    unsigned long sum;
    unsigned channel, a40, a320;
    if (strncmp(line, "out ", 4) == 0) {
        size_t n = read_hex(line + 4, wanted, sizeof wanted);
        int same = n == n_sent && memcmp(wanted, sent, n) == 0;
        n_sent = 0;
        return same;
    }
    if (sscanf(line, "state %15s %lu", name, &sum) == 2) {
        return strcmp(name, states[device.state]) == 0 && sum == hbp_amp_sum(&device);
    }
    if (sscanf(line, "drive %u %u %u", &channel, &a40, &a320) == 3) {
        return channel < HBP_CHANNELS && low(device.drive[channel]) == a40
            && high(device.drive[channel]) == a320;
    }
    return -1;
}

static int run_sessions(const char *path)
{
    static char line[1 << 19];
    char name[64] = "";
    unsigned number = 0, n_sessions = 0, n_checks = 0, n_wrong = 0;
    FILE *file = fopen(path, "r");
    if (!file) {
        fprintf(stderr, "hbp_host: cannot open %s\n", path);
        return 2;
    }
    while (fgets(line, sizeof line, file)) {
        char *text = line + strspn(line, " \t");
        int held;
        number++;
        if (sscanf(text, "session %63s", name) == 1) {
            n_sessions++;
            boot();
        } else if (n_sessions > 0 && (held = holds(text)) >= 0) {
            n_checks++;
            if (!held) {
                n_wrong++;
                printf("%s:%u: session %s: %s", path, number, name, text);
            }
        } else if (n_sessions > 0) {
            obey(text);
        }
    }
    fclose(file);
    printf("%u sessions, %u checks, %u wrong\n", n_sessions, n_checks, n_wrong);
    return n_sessions == 0 || n_wrong > 0;
}

int main(int argc, char **argv)
{
    return argc > 1 ? run_sessions(argv[1]) : obey_input();
}
