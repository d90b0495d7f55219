/* startup.c - vectors and the way to main, without a C library.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#include "restart.h"

volatile uint32_t restart_mark __attribute__((section(".noinit")));

extern uint32_t stack_top, data_start, data_end, data_in_flash, bss_start, bss_end;

int main(void);
void systick_interrupt(void);
void uart_interrupt(void);
void reset(void);

/* Whatever should not happen: start anew. The reset makes every pin an input, so that the high
 * voltage is off at once, and the mark tells main to report it. */
static void restart(void)
{
    restart_mark = RESTARTED_BY_FAULT;
    __asm volatile("dsb" ::: "memory");
    *(volatile uint32_t *)0xE000ED0Cu = 0x05FA0004u;
    for (;;) {
    }
}

void reset(void)
{
    uint32_t *from = &data_in_flash, *to;
    for (to = &data_start; to < &data_end;) *to++ = *from++;
    for (to = &bss_start; to < &bss_end;) *to++ = 0;
    main();
    restart(); /* main does not end */
}

/* Stack, exceptions 1 to 15, interrupts 0 to 5. */
__attribute__((section(".vectors"), used)) static void (*const vectors[])(void) = {
    (void (*)(void))(uintptr_t)&stack_top, reset,
    restart, restart, restart, restart, restart, 0, 0, 0, 0, restart, restart, 0, restart,
    systick_interrupt,
    restart, restart, restart, restart, restart, uart_interrupt
};
