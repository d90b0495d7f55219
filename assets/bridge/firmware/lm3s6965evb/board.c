/* board.c - the core on a Stellaris LM3S6965 evaluation board, real or emulated:
 *
 *   qemu-system-arm -M lm3s6965evb -nographic -monitor none -serial pty -kernel hbp_emulated.elf
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * UART0 is the link (1,000,000 baud, 8N1), SysTick the 1 ms clock, PF0 (the status LED) stands for
 * the high-voltage enable: a resistor of 10 kOhm pulls it to ground, so that it is off whenever
 * this program does not drive it. The board has no converters: samples are made and thrown away
 * where a real array would clock them out.
 *
 * Interrupts only move bytes and count: SysTick counts ms and makes samples, the UART fills and
 * drains rings. The loop in main does everything else and sleeps in between.
 */
#include "../hbp_core.h"
#include "restart.h"

#define REGISTER(address) (*(volatile uint32_t *)(address))

#define WATCHDOG(offset) REGISTER(0x40000000u + (offset))
#define GPIO_F(offset) REGISTER(0x40025000u + (offset))
#define SYSTEM(offset) REGISTER(0x400FE000u + (offset))
#define UART(offset) REGISTER(0x4000C000u + (offset))
#define GPIO_A(offset) REGISTER(0x40004000u + (offset))
#define SYSTICK(offset) REGISTER(0xE000E010u + (offset))
#define NVIC_ENABLE REGISTER(0xE000E100u)

enum { SYSTEM_PBORCTL = 0x030, SYSTEM_RIS = 0x050, SYSTEM_RESC = 0x05C, SYSTEM_RCC = 0x060 };
enum { SYSTEM_RCGC0 = 0x100, SYSTEM_RCGC1 = 0x104, SYSTEM_RCGC2 = 0x108 };
enum { RESC_POWER_ON = 1 << 1, RESC_BROWN_OUT = 1 << 2, RESC_WATCHDOG = 1 << 3 };
enum { GPIO_PF0 = 0x004, GPIO_DIRECTION = 0x400, GPIO_FUNCTION = 0x420, GPIO_DIGITAL = 0x51C };
enum { UART_DATA = 0x00, UART_FLAGS = 0x18, UART_INTEGER = 0x24, UART_FRACTION = 0x28 };
enum { UART_LINE = 0x2C, UART_CONTROL = 0x30, UART_MASK = 0x38, UART_CLEAR = 0x44 };
enum { UART_RX_EMPTY = 1 << 4, UART_TX_FULL = 1 << 5 };

#define CLOCKS_PER_US 50u
#define RING 1024u /* a power of two, more than the largest packet */

typedef struct {
    volatile uint8_t bytes[RING];
    volatile uint32_t in, out; /* count up for ever: one side writes each */
} ring;

static hbp_device device;
static ring received, waiting;
static volatile uint32_t ms;

/* ---- Interrupts -------------------------------------------------------------------------- */

void systick_interrupt(void);
void uart_interrupt(void);

void systick_interrupt(void)
{
    uint16_t codes[HBP_CHANNELS];
    unsigned i;
    ms++;
    /* A real array takes one set every 125 us from a timer and sends it to its converters. */
    for (i = 0; i < 8; i++) hbp_sample(&device, codes);
}

static void transmit(void)
{
    while (waiting.out != waiting.in && !(UART(UART_FLAGS) & UART_TX_FULL)) {
        UART(UART_DATA) = waiting.bytes[waiting.out % RING];
        waiting.out++;
    }
}

void uart_interrupt(void)
{
    UART(UART_CLEAR) = 0x7FF;
    while (!(UART(UART_FLAGS) & UART_RX_EMPTY)) {
        uint8_t byte = (uint8_t)UART(UART_DATA);
        /* Full: the byte is lost, its packet fails the CRC and counts as bad. */
        if (received.in - received.out < RING) {
            received.bytes[received.in % RING] = byte;
            received.in++;
        }
    }
    transmit();
}

static void interrupts_off(void) { __asm volatile("cpsid i" ::: "memory"); }
static void interrupts_on(void) { __asm volatile("cpsie i" ::: "memory"); }

/* ---- What the core needs ----------------------------------------------------------------- */

static void send(void *context, const uint8_t *bytes, uint16_t length)
{
    uint16_t i;
    (void)context;
    if (RING - (waiting.in - waiting.out) < length) {
        return; /* a device never waits for its host */
    }
    for (i = 0; i < length; i++) waiting.bytes[(waiting.in + i) % RING] = bytes[i];
    interrupts_off();
    waiting.in += length;
    transmit();
    interrupts_on();
}

static uint16_t volts_dv;

static void high_voltage(void *context, uint16_t dv)
{
    (void)context;
    volts_dv = dv;
    GPIO_F(GPIO_PF0) = dv > 0; /* PF0 alone */
}

/* Nothing to measure with: the voltage is what was asked for. */
static void measure(void *context, hbp_measured *measured)
{
    (void)context;
    measured->hv_dv = volts_dv;
}

/* ---- Start ------------------------------------------------------------------------------- */

/* 50 MHz from the 8 MHz crystal: PLL of 200 MHz divided by 4. */
static void start_clock(void)
{
    uint32_t rcc = SYSTEM(SYSTEM_RCC);
    rcc = (rcc | 1u << 11) & ~(1u << 22);
    SYSTEM(SYSTEM_RCC) = rcc; /* off the PLL while it changes */
    rcc &= ~(0x3u << 12 | 0xFu << 6 | 0x3u << 4 | 0xFu << 23 | 1u);
    rcc |= 0xEu << 6 | 3u << 23 | 1u << 22;
    SYSTEM(SYSTEM_RCC) = rcc;
    while (!(SYSTEM(SYSTEM_RIS) & 1u << 6)) {
    }
    SYSTEM(SYSTEM_RCC) = rcc & ~(1u << 11);
}

/* PF0 drives the enable from here on, low; until now it was an input, and the resistor held it. */
static void start_high_voltage_pin(void)
{
    SYSTEM(SYSTEM_RCGC2) |= 1u << 5;
    (void)SYSTEM(SYSTEM_RCGC2); /* a port is not touched before its clock runs: a bus fault */
    GPIO_F(GPIO_PF0) = 0;
    GPIO_F(GPIO_DIRECTION) |= 1u;
    GPIO_F(GPIO_DIGITAL) |= 1u;
}

static void start_uart(void)
{
    SYSTEM(SYSTEM_RCGC1) |= 1u;
    SYSTEM(SYSTEM_RCGC2) |= 1u;
    (void)SYSTEM(SYSTEM_RCGC2);
    GPIO_A(GPIO_FUNCTION) |= 3u;
    GPIO_A(GPIO_DIGITAL) |= 3u;
    UART(UART_CONTROL) = 0;
    UART(UART_INTEGER) = 3; /* 50 MHz / 16 / 1 MHz = 3 + 8/64 */
    UART(UART_FRACTION) = 8;
    UART(UART_LINE) = 0x70; /* 8 bits, FIFOs */
    UART(UART_MASK) = 0x70; /* receive, receive time-out, transmit */
    UART(UART_CONTROL) = 0x301;
    NVIC_ENABLE = 1u << 5;
}

static void start_systick(void)
{
    SYSTICK(4) = 1000u * CLOCKS_PER_US - 1;
    SYSTICK(8) = 0;
    SYSTICK(0) = 7;
}

/* Resets the board when the loop has not come round for 50 ms. HBP_NO_WATCHDOG is for emulators
 * alone: on a busy desktop an emulated loop can take longer than that. */
static void start_watchdog(void)
{
#ifndef HBP_NO_WATCHDOG
    SYSTEM(SYSTEM_RCGC0) |= 1u << 3;
    (void)SYSTEM(SYSTEM_RCGC0);
    WATCHDOG(0x000) = 25000u * CLOCKS_PER_US; /* resets at the second expiry */
    WATCHDOG(0x008) = 3;
#endif
}

static void kick_watchdog(void)
{
#ifndef HBP_NO_WATCHDOG
    WATCHDOG(0x00C) = 1;
#endif
}

/* Was this no wanted start: a hard fault, the watchdog, a brown-out? Asked once, then forgotten.
 * When the power came on, the other bits and the mark are what chance left there. */
static int restarted_by_trouble(void)
{
    uint32_t causes = SYSTEM(SYSTEM_RESC);
    int marked = restart_mark == RESTARTED_BY_FAULT;
    restart_mark = 0;
    SYSTEM(SYSTEM_RESC) = 0;
    SYSTEM(SYSTEM_PBORCTL) |= 1u << 1; /* a brown-out resets; it would only interrupt */
    return !(causes & RESC_POWER_ON) && (marked || causes & (RESC_BROWN_OUT | RESC_WATCHDOG));
}

static uint16_t phase_us(void)
{
    uint32_t us = (1000u * CLOCKS_PER_US - 1 - SYSTICK(8)) / CLOCKS_PER_US;
    return (uint16_t)(us < 999 ? us : 999);
}

int main(void)
{
    static const hbp_port port = { 0, send, high_voltage, measure, 0 };
    uint32_t stepped = 0;
    start_high_voltage_pin();
    start_clock();
    hbp_init(&device, &port);
    if (restarted_by_trouble()) {
        hbp_raise_fault(&device, 0, HBP_WATCHDOG, 0xFFFF, 0);
        hbp_end_fault_cause(&device, HBP_WATCHDOG); /* it is over: CLEAR will do */
    }
    start_watchdog();
    start_uart();
    start_systick();
    for (;;) {
        kick_watchdog();
        while (stepped != ms) {
            stepped++;
            hbp_step_ms(&device);
        }
        while (received.out != received.in && stepped == ms) {
            uint8_t byte = received.bytes[received.out % RING];
            received.out++;
            hbp_receive(&device, phase_us(), byte);
        }
        /* An interrupt that comes between the question and the sleep still ends the sleep. */
        interrupts_off();
        if (stepped == ms && received.out == received.in) __asm volatile("wfi");
        interrupts_on();
    }
}
