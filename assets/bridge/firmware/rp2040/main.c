/* main.c - the core on an RP2040 (Raspberry Pi Pico): USB serial port, converters, high voltage.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * One timer is the only clock: its interrupt comes every 125 us, makes a sample of all channels,
 * keeps the dead-man of the high voltage alive, and counts every eighth as a millisecond. The loop
 * in main does everything else and kicks the watchdog. So a loop that hangs is silent after 20 ms
 * (by hbp_sample) and reset after 50 ms (by the watchdog), and a processor that stands still loses
 * its high voltage within 5 ms (by the dead-man). One core does it all; the other sleeps.
 */
#include "hardware/adc.h"
#include "hardware/gpio.h"
#include "hardware/structs/vreg_and_chip_reset.h"
#include "hardware/watchdog.h"
#include "pico/stdlib.h"
#include "pico/unique_id.h"
#include "tusb.h"

#include "board.h"
#include "converters.h"

enum { SAMPLE_US = 125, SAMPLES_PER_MS = 8, WATCHDOG_MS = 50 };

static hbp_device device;
static volatile uint32_t ms, ms_began_us;

/* ---- The sample interrupt ---------------------------------------------------------------- */

static bool sample_interrupt(repeating_timer_t *timer)
{
    static uint32_t n_samples;
    uint16_t codes[HBP_CHANNELS];
    (void)timer;
    converters_update(); /* what was made last time: so samples come out at an even pace */
    hbp_sample(&device, codes);
    converters_write(codes);
    if (!device.stale) gpio_xor_mask(1u << PIN_DEAD_MAN);
    if (++n_samples % SAMPLES_PER_MS == 0) {
        ms_began_us = time_us_32();
        ms++;
    }
    return true; /* go on */
}

/* ---- What the core needs ----------------------------------------------------------------- */

static void send(void *context, const uint8_t *bytes, uint16_t length)
{
    (void)context;
    if (tud_cdc_write_available() < length) return; /* a device never waits for its host */
    tud_cdc_write(bytes, length);
    tud_cdc_write_flush();
}

/* The supply has one voltage, or sets it by itself; here it is switched. */
static void high_voltage(void *context, uint16_t dv)
{
    (void)context;
    gpio_put(PIN_HV_ENABLE, dv > 0);
}

static void measure(void *context, hbp_measured *measured)
{
    (void)context;
    measured->hv_dv = (uint16_t)((uint32_t)adc_read() * HV_FULL_SCALE_DV / 4095u);
}

/* ---- Start ------------------------------------------------------------------------------- */

/* Both pins were inputs until now; the resistor held the supply off. */
static void start_high_voltage_pins(void)
{
    gpio_init(PIN_HV_ENABLE);
    gpio_put(PIN_HV_ENABLE, 0);
    gpio_set_dir(PIN_HV_ENABLE, 1);
    gpio_init(PIN_DEAD_MAN);
    gpio_set_dir(PIN_DEAD_MAN, 1);
    adc_init();
    adc_gpio_init(PIN_HV_MEASURED);
    adc_select_input(ADC_HV_MEASURED);
}

/* The 8 bytes of the flash chip's own number, then "PICO". */
static const uint8_t *board_uid(void)
{
    static uint8_t uid[12] = { 0, 0, 0, 0, 0, 0, 0, 0, 'P', 'I', 'C', 'O' };
    pico_unique_board_id_t id;
    unsigned i;
    pico_get_unique_board_id(&id);
    for (i = 0; i < PICO_UNIQUE_BOARD_ID_SIZE_BYTES && i < sizeof uid; i++) uid[i] = id.id[i];
    return uid;
}

/* Nothing clears this RAM at a start; it keeps its contents when the supply sags for a moment. */
#define RUNNING 0x52554E21u
static uint32_t __uninitialized_ram(running_mark)[2];

/* Was this no wanted start? A hard fault ends in the watchdog too. The chip cannot tell a brown-out
 * from power that comes on; RAM that still says "running" can. Asked once, then forgotten. */
static bool restarted_by_trouble(void)
{
    bool power = vreg_and_chip_reset_hw->chip_reset & VREG_AND_CHIP_RESET_CHIP_RESET_HAD_POR_BITS;
    bool was_running = running_mark[0] == RUNNING && running_mark[1] == ~RUNNING;
    running_mark[0] = RUNNING;
    running_mark[1] = ~RUNNING;
    if (watchdog_caused_reboot()) return watchdog_enable_caused_reboot();
    return power && was_running;
}

/* In place of the sdk's own handler. The watchdog is no longer kicked and resets the chip. */
void isr_hardfault(void);
void isr_hardfault(void)
{
    gpio_put(PIN_HV_ENABLE, 0);
    for (;;) {
    }
}

/* ---- The loop ---------------------------------------------------------------------------- */

static uint16_t phase_us(void)
{
    uint32_t us = time_us_32() - ms_began_us;
    return (uint16_t)(us < 999 ? us : 999);
}

/* USB suspended or reset, or the plug pulled: no longer ready. DTR dropped: no longer connected. A
 * host that never raises DTR is heard all the same. */
static void watch_link(void)
{
    static bool was_ready, was_connected;
    bool is_ready = tud_ready(), is_connected = tud_cdc_connected();
    if ((was_ready && !is_ready) || (was_connected && !is_connected)) hbp_link_lost(&device);
    was_ready = is_ready;
    was_connected = is_connected;
}

int main(void)
{
    static repeating_timer_t timer;
    hbp_port port = { 0, send, high_voltage, measure, 0 };
    uint32_t stepped = 0;
    start_high_voltage_pins();
    converters_start();
    port.uid = board_uid();
    hbp_init(&device, &port);
    if (restarted_by_trouble()) {
        hbp_raise_fault(&device, 0, HBP_WATCHDOG, 0xFFFF, 0);
        hbp_end_fault_cause(&device, HBP_WATCHDOG); /* it is over: CLEAR will do */
    }
    tusb_init();
    watchdog_enable(WATCHDOG_MS, 0);
    add_repeating_timer_us(-SAMPLE_US, sample_interrupt, 0, &timer); /* negative: start to start */
    for (;;) {
        watchdog_update();
        tud_task();
        watch_link();
        while (stepped != ms) {
            stepped++;
            hbp_step_ms(&device);
        }
        while (stepped == ms && tud_cdc_available() > 0) {
            hbp_receive(&device, phase_us(), (uint8_t)tud_cdc_read_char());
        }
    }
}
