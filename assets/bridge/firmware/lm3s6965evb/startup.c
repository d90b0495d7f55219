/* startup.c - vectors and the way to main, without a C library.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#include <stdint.h>

extern uint32_t stack_top, data_start, data_end, data_in_flash, bss_start, bss_end;

int main(void);
void systick_interrupt(void);
void uart_interrupt(void);
void reset(void);

void reset(void)
{
    uint32_t *from = &data_in_flash, *to;
    for (to = &data_start; to < &data_end;) *to++ = *from++;
    for (to = &bss_start; to < &bss_end;) *to++ = 0;
    main();
    for (;;) {
    }
}

/* Whatever should not happen: start anew, with the high voltage off. */
static void restart(void)
{
    *(volatile uint32_t *)0xE000ED0Cu = 0x05FA0004u;
    for (;;) {
    }
}

/* Stack, exceptions 1 to 15, interrupts 0 to 5. */
__attribute__((section(".vectors"), used)) static void (*const vectors[])(void) = {
    (void (*)(void))(uintptr_t)&stack_top, reset,
    restart, restart, restart, restart, restart, 0, 0, 0, 0, restart, restart, 0, restart,
    systick_interrupt,
    restart, restart, restart, restart, restart, uart_interrupt
};
