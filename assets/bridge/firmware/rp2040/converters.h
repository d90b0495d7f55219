/* converters.h - the digital-to-analogue converters, all that main.c knows of them.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#ifndef CONVERTERS_H
#define CONVERTERS_H

#include "../hbp_core.h"

/* Once, before interrupts: all channels at mid-scale. */
void converters_start(void);
/* Hands over the next code of each channel, 12 bits around 2048. They are not put out yet. */
void converters_write(const uint16_t codes[HBP_CHANNELS]);
/* Puts out what was handed over, all channels at the same moment. */
void converters_update(void);

#endif
