/* restart.h - how a start after a fault is told from one that was wanted.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#ifndef RESTART_H
#define RESTART_H

#include <stdint.h>

#define RESTARTED_BY_FAULT 0x4F4F5053u

/* In RAM that no start clears: the fault handlers of startup.c write RESTARTED_BY_FAULT here before
 * they reset the board. */
extern volatile uint32_t restart_mark;

#endif
